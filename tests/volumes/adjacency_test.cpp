// Neighbourhoods of triangles, judged by comparing every side with every other.
#include "renderer/frame/adjacency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/frame/gpu_scene.h"

namespace penumbra {
namespace {

using testing::ElementsAre;

struct Triangles {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
};

Adjacency adjacency_of(const Triangles& mesh) {
  DrawRange range;
  range.index_count = static_cast<std::uint32_t>(mesh.indices.size());
  return build_adjacency(mesh.positions, mesh.indices, std::vector{range});
}

/// A box of six faces with four corners each of their own, as normals split them.
Triangles split_box() {
  Triangles mesh;
  const glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const glm::vec3 n = side * axes[axis];
      const glm::vec3 u = axes[(axis + 1) % 3];
      const glm::vec3 v = glm::cross(n, u);
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const glm::vec2 c : std::vector<glm::vec2>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        mesh.positions.push_back(n + c.x * u + c.y * v);
      for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
    }
  return mesh;
}

/// Corner opposite to the side of `triangle` that starts at `corner`, over all triangles that share
/// both ends of it.
std::vector<glm::vec3> opposites(const Triangles& mesh, std::size_t triangle, std::size_t corner) {
  const auto at = [&](std::size_t t, std::size_t k) {
    return mesh.positions[mesh.indices[3 * t + k % 3]];
  };
  const glm::vec3 a = at(triangle, corner), b = at(triangle, corner + 1);
  std::vector<glm::vec3> found;
  for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (t != triangle &&
          ((at(t, k) == a && at(t, k + 1) == b) || (at(t, k) == b && at(t, k + 1) == a)))
        found.push_back(at(t, k + 2));
  return found;
}

TEST(Adjacency, joins_every_side_of_a_box_across_corners_that_normals_split) {
  const Triangles box = split_box();
  const Adjacency adjacency = adjacency_of(box);
  ASSERT_EQ(adjacency.indices.size(), 2 * box.indices.size());
  for (std::size_t t = 0; t < 12; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(box.positions[adjacency.indices[6 * t + 2 * k]],
                box.positions[box.indices[3 * t + k]]);
      EXPECT_THAT(opposites(box, t, k),
                  ElementsAre(box.positions[adjacency.indices[6 * t + 2 * k + 1]]));
    }
  ASSERT_EQ(adjacency.groups.size(), 1u);
  EXPECT_TRUE(adjacency.groups[0].closed);
  EXPECT_EQ(adjacency.open_edges, 0u);
  EXPECT_EQ(adjacency.groups[0].low, glm::vec3(-1.0f));
  EXPECT_EQ(adjacency.groups[0].high, glm::vec3(1.0f));
}

TEST(Adjacency, of_a_box_without_a_face_is_open_along_four_edges) {
  Triangles box = split_box();
  box.indices.resize(30);
  const Adjacency adjacency = adjacency_of(box);
  EXPECT_EQ(adjacency.open_edges, 4u);
  ASSERT_EQ(adjacency.groups.size(), 1u);
  EXPECT_FALSE(adjacency.groups[0].closed);
}

TEST(Adjacency, marks_an_open_edge_by_its_own_corner) {
  const Triangles one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}};
  EXPECT_THAT(adjacency_of(one).indices, ElementsAre(0, 0, 1, 1, 2, 2));
}

TEST(Adjacency, joins_two_triangles_however_they_are_wound) {
  Triangles two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 2, 1, 3}};
  EXPECT_THAT(adjacency_of(two).indices, ElementsAre(0, 0, 1, 3, 2, 2, 2, 0, 1, 1, 3, 3));
  two.indices = {0, 1, 2, 1, 2, 3};
  EXPECT_THAT(adjacency_of(two).indices, ElementsAre(0, 0, 1, 3, 2, 2, 1, 0, 2, 2, 3, 3));
}

TEST(Adjacency, of_two_triangles_back_to_back_encloses_no_space) {
  // One of the two is lit wherever it is seen: a volume that ends in either is no body's.
  Triangles two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 1}};
  EXPECT_FALSE(adjacency_of(two).groups[0].closed);
  two.indices = {0, 1, 2, 0, 1, 2};
  EXPECT_FALSE(adjacency_of(two).groups[0].closed);
}

TEST(Adjacency, of_a_box_that_is_modelled_from_both_sides_encloses_no_space) {
  Triangles box = split_box();
  const std::vector<std::uint32_t> once = box.indices;
  for (std::size_t i = 0; i + 2 < once.size(); i += 3)
    box.indices.insert(box.indices.end(), {once[i], once[i + 2], once[i + 1]});
  const Adjacency adjacency = adjacency_of(box);
  ASSERT_EQ(adjacency.groups.size(), 1u);
  EXPECT_FALSE(adjacency.groups[0].closed);
  EXPECT_EQ(adjacency.open_edges, 0u);
}

TEST(Adjacency, gives_a_side_of_many_triangles_the_neighbour_with_the_closest_normal) {
  // Three leaves on the edge from 0 to 1: one along -x, and of the two others one almost continues
  // it.
  const Triangles leaves{{{0, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {1, 0.1f, 0}, {0.2f, 1, 0}},
                         {0, 1, 2, 1, 0, 3, 1, 0, 4}};
  const Adjacency adjacency = adjacency_of(leaves);
  EXPECT_EQ(adjacency.non_manifold_edges, 1u);
  EXPECT_EQ(adjacency.indices[1], 3u);
  EXPECT_EQ(adjacency.indices[7], 2u);
  EXPECT_EQ(adjacency.indices[13], 1u) << "the third leaf is open there";
}

TEST(Adjacency, keeps_two_boxes_closed_that_share_an_edge) {
  Triangles boxes = split_box();
  const Triangles other = split_box();
  for (const glm::vec3& p : other.positions) boxes.positions.push_back(p + glm::vec3(2, 2, 0));
  for (const std::uint32_t i : other.indices) boxes.indices.push_back(i + 24);
  const Adjacency adjacency = adjacency_of(boxes);
  EXPECT_EQ(adjacency.non_manifold_edges, 1u);
  ASSERT_EQ(adjacency.groups.size(), 1u);
  EXPECT_TRUE(adjacency.groups[0].closed);
}

TEST(Adjacency, leaves_degenerate_triangles_out_of_all_neighbourhoods) {
  Triangles box = split_box();
  box.indices.insert(box.indices.end(), {0, 1, 1, 2, 2, 2});
  const Adjacency adjacency = adjacency_of(box);
  EXPECT_EQ(adjacency.degenerate_triangles, 2u);
  EXPECT_EQ(adjacency.open_edges, 0u);
  EXPECT_EQ(adjacency.indices.size(), 2 * box.indices.size());
}

TEST(Adjacency, does_not_join_instances) {
  const Triangles two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 2, 1, 3}};
  DrawRange first, second;
  first.index_count = second.index_count = 3;
  second.first_index = 3;
  second.instance = 1;
  const Adjacency adjacency =
      build_adjacency(two.positions, two.indices, std::vector{first, second});
  EXPECT_EQ(adjacency.open_edges, 6u);
  EXPECT_EQ(adjacency.groups.size(), 2u);
}

}  // namespace
}  // namespace penumbra
