// Which triangles belong to closed bodies.
#include "renderer/frame/closed_bodies.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "renderer/frame/triangle_order.h"
#include "renderer/scene/scene.h"

namespace penumbra {
namespace {

using testing::Each;
using testing::ElementsAreArray;

struct Skin {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> corners;

  std::vector<bool> closed() const { return in_closed_bodies(positions, corners); }
  void append(const Skin& more) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), more.positions.begin(), more.positions.end());
    for (const std::uint32_t corner : more.corners) corners.push_back(first + corner);
  }
  void turn() {
    for (std::size_t i = 0; i < corners.size(); i += 3) std::swap(corners[i + 1], corners[i + 2]);
  }
};

/// Twelve triangles, counter-clockwise from outside.
Skin unit_box(const glm::vec3& low) {
  Skin box;
  for (int i = 0; i < 8; ++i) box.positions.push_back(low + glm::vec3(i & 1, i >> 1 & 1, i >> 2));
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    for (const std::uint32_t corner : {a, b, c, a, c, d}) box.corners.push_back(corner);
  return box;
}

TEST(ClosedBodies, have_no_edge_and_are_wound_outwards) {
  // Far from the origin volumes are small differences.
  for (const float away : {0.0f, 1000.0f}) {
    Skin body = unit_box(glm::vec3(away));
    EXPECT_THAT(body.closed(), Each(true)) << away;
    body.turn();
    EXPECT_THAT(body.closed(), Each(false)) << away;
  }
}

TEST(ClosedBodies, are_told_body_by_body) {
  Skin open = unit_box(glm::vec3(3.0f));
  open.corners.resize(33);
  Skin inwards = unit_box(glm::vec3(6.0f));
  inwards.turn();
  Skin all = unit_box(glm::vec3(0.0f));
  all.append(open);
  all.append(inwards);
  std::vector<bool> expected(12 + 11 + 12);
  std::fill_n(expected.begin(), 12, true);
  EXPECT_THAT(all.closed(), ElementsAreArray(expected));
}

TEST(ClosedBodies, that_touch_at_a_place_are_told_apart) {
  // A room wound inwards at the corner of a larger body, and joined to it by what covers nothing.
  Skin all = unit_box(glm::vec3(0.0f));
  for (glm::vec3& place : all.positions) place *= 4.0f;
  Skin room = unit_box(glm::vec3(4.0f));
  room.turn();
  all.append(room);
  for (std::uint32_t& corner : all.corners)
    if (corner == 8) corner = 7;
  for (const std::uint32_t corner : {0u, 0u, 9u}) all.corners.push_back(corner);
  const std::vector<bool> closed = all.closed();
  for (std::size_t t = 0; t < 24; ++t) EXPECT_EQ(closed[t], t < 12) << t;
}

TEST(ClosedBodies, are_none_where_one_face_is_wound_the_other_way_or_there_twice) {
  Skin body = unit_box(glm::vec3(0.0f));
  std::swap(body.corners[1], body.corners[2]);
  EXPECT_THAT(body.closed(), Each(false));
  Skin doubled = unit_box(glm::vec3(0.0f));
  for (int k = 0; k < 3; ++k) doubled.corners.push_back(doubled.corners[k]);
  EXPECT_THAT(doubled.closed(), Each(false));
}

TEST(ClosedBodies, may_have_triangles_that_cover_nothing) {
  Skin body = unit_box(glm::vec3(0.0f));
  for (const std::uint32_t corner : {0u, 0u, 1u}) body.corners.push_back(corner);
  const std::vector<bool> closed = body.closed();
  EXPECT_THAT(std::vector<bool>(closed.begin(), closed.begin() + 12), Each(true));
}

TEST(ClosedBodies, of_many_triangles_around_one_place_take_no_time) {
  // Two cones on one another: every triangle has one of two places.
  constexpr std::uint32_t around = 200'000;
  Skin body;
  body.positions = {{0, 1, 0}, {0, -1, 0}};
  for (std::uint32_t i = 0; i < around; ++i) {
    const double angle = 6.283185307179586 * i / around;
    body.positions.emplace_back(std::cos(angle), 0.0, std::sin(angle));
    const std::uint32_t here = 2 + i, next = 2 + (i + 1) % around;
    for (const std::uint32_t corner : {0u, next, here, 1u, here, next})
      body.corners.push_back(corner);
  }
  EXPECT_THAT(body.closed(), Each(true));
}

/// One primitive a list of triangles.
Mesh mesh_of(const std::vector<Skin>& parts) {
  Mesh mesh;
  for (const Skin& part : parts) {
    const auto first = static_cast<std::uint32_t>(mesh.indices.size());
    const auto vertex = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::uint32_t corner : part.corners) mesh.indices.push_back(vertex + corner);
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
    mesh.primitives.push_back({first, static_cast<std::uint32_t>(part.corners.size()), 0});
  }
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0f, 1.0f, 0.0f));
  return mesh;
}

TEST(TriangleOrder, begins_with_closed_bodies) {
  Skin open = unit_box(glm::vec3(3.0f));
  open.corners.resize(33);
  Skin both = open;
  both.append(unit_box(glm::vec3(0.0f)));
  const Mesh mesh = mesh_of({both});
  const TriangleOrder order = triangle_order(mesh, {true});
  EXPECT_THAT(order.closed, ElementsAreArray({36u}));
  for (std::size_t i = 0; i < order.corners.size(); ++i)
    EXPECT_EQ(mesh.positions[order.corners[i]].x < 2.0f, i < 36) << i;
}

TEST(TriangleOrder, closes_bodies_of_several_primitives_where_all_are_solid) {
  Skin upper = unit_box(glm::vec3(0.0f)), lower = upper;
  upper.corners.resize(18);
  lower.corners.erase(lower.corners.begin(), lower.corners.begin() + 18);
  const Mesh mesh = mesh_of({upper, lower, unit_box(glm::vec3(5.0f))});
  EXPECT_THAT(triangle_order(mesh, {true, true, true}).closed, ElementsAreArray({18u, 18u, 36u}));
  EXPECT_THAT(triangle_order(mesh, {true, false, true}).closed, ElementsAreArray({0u, 0u, 36u}));
}

TEST(TriangleOrder, bears_primitives_that_share_triangles) {
  Skin all = unit_box(glm::vec3(0.0f));
  Mesh mesh = mesh_of({all});
  mesh.primitives.push_back({6, 12, 0});
  const TriangleOrder order = triangle_order(mesh, {true, false});
  EXPECT_THAT(order.closed, ElementsAreArray({36u, 0u}));
  EXPECT_THAT(order.first, ElementsAreArray({std::size_t{0}, std::size_t{36}}));
  EXPECT_EQ(order.corners.size(), 48u);
  const auto triangle_set = [&](std::size_t first, std::size_t count) {
    std::multiset<std::array<std::uint32_t, 3>> found;
    for (std::size_t i = first; i < first + count; i += 3)
      found.insert({order.corners[i], order.corners[i + 1], order.corners[i + 2]});
    return found;
  };
  std::multiset<std::array<std::uint32_t, 3>> given, part;
  for (std::size_t i = 0; i < 36; i += 3) {
    const std::array<std::uint32_t, 3> one{mesh.indices[i], mesh.indices[i + 1],
                                           mesh.indices[i + 2]};
    given.insert(one);
    if (i >= 6 && i < 18) part.insert(one);
  }
  EXPECT_EQ(triangle_set(0, 36), given);
  EXPECT_EQ(triangle_set(36, 12), part);
}

}  // namespace
}  // namespace penumbra
