// The order in which a mesh's triangles are drawn.
#include "renderer/frame/triangle_order.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "renderer/scene/scene.h"

namespace penumbra {
namespace {

constexpr std::uint32_t side = 40;

/// A square of quads with corners of its own for each triangle, as some exporters write them, in
/// any order. The left half is one primitive, the right half another.
Mesh torn_square(bool with_seam) {
  std::vector<std::array<glm::vec2, 3>> halves[2];
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const glm::vec2 at(x, y);
      auto& half = halves[x < side / 2 ? 0 : 1];
      half.push_back({at, at + glm::vec2(1, 0), at + glm::vec2(1, 1)});
      half.push_back({at, at + glm::vec2(1, 1), at + glm::vec2(0, 1)});
    }
  Mesh mesh;
  std::mt19937 random(7);
  for (auto& half : halves) {
    std::shuffle(half.begin(), half.end(), random);
    const auto first = static_cast<std::uint32_t>(mesh.indices.size());
    for (const auto& triangle : half)
      for (const glm::vec2& corner : triangle) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.emplace_back(corner, 0.0f);
        mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
        mesh.uvs.push_back(with_seam ? glm::vec2(mesh.uvs.size(), 0.0f) : corner);
      }
    mesh.primitives.push_back({first, static_cast<std::uint32_t>(mesh.indices.size()) - first, 0u});
  }
  return mesh;
}

/// Triangles of a primitive by the places of their corners, in the order of their winding.
std::multiset<std::array<float, 6>> triangles(const Mesh& mesh, const Primitive& primitive,
                                              const std::vector<std::uint32_t>& corners) {
  std::multiset<std::array<float, 6>> all;
  for (std::uint32_t i = 0; i < primitive.index_count; i += 3) {
    std::array<float, 6> places{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const glm::vec3& at = mesh.positions[corners[primitive.first_index + i + k]];
      places[2 * k] = at.x;
      places[2 * k + 1] = at.y;
    }
    all.insert(places);
  }
  return all;
}

/// Corners that a cache of 256 places, by the lower bits of the index, does not hold.
std::size_t misses(const std::vector<std::uint32_t>& corners) {
  std::array<std::uint32_t, 256> cache;
  cache.fill(~0u);
  std::size_t count = 0;
  for (const std::uint32_t corner : corners) {
    count += cache[corner % 256] != corner;
    cache[corner % 256] = corner;
  }
  return count;
}

TEST(TriangleOrder, keeps_every_triangle_its_winding_and_its_primitive) {
  for (const bool with_seam : {false, true}) {
    const Mesh mesh = torn_square(with_seam);
    const TriangleOrder order = triangle_order(mesh, {true, true});
    ASSERT_EQ(order.corners.size(), mesh.indices.size());
    for (const Primitive& primitive : mesh.primitives)
      EXPECT_EQ(triangles(mesh, primitive, order.corners),
                triangles(mesh, primitive, mesh.indices));
  }
}

TEST(TriangleOrder, makes_vertices_one_that_are_alike_in_everything) {
  const auto distinct = [](const std::vector<std::uint32_t>& list) {
    return std::set<std::uint32_t>(list.begin(), list.end()).size();
  };
  constexpr std::size_t places = (side + 1) * (side + 1);
  const Mesh smooth = torn_square(false);
  EXPECT_EQ(distinct(triangle_order(smooth, {true, true}).corners), places);
  const Mesh seam = torn_square(true);
  const TriangleOrder order = triangle_order(seam, {true, true});
  EXPECT_EQ(distinct(order.corners), seam.indices.size()) << "coordinates of textures differ";
  EXPECT_EQ(distinct(order.first_at), places);
  for (std::size_t v = 0; v < seam.positions.size(); ++v)
    EXPECT_EQ(seam.positions[order.first_at[v]], seam.positions[v]);
}

TEST(TriangleOrder, brings_neighbours_together) {
  const Mesh mesh = torn_square(false);
  std::vector<std::uint32_t> places;
  const TriangleOrder order = triangle_order(mesh, {true, true});
  for (const std::uint32_t corner : mesh.indices) places.push_back(order.first_at[corner]);
  // A corner a quad, where all are found again; any order asks for most of its six anew.
  EXPECT_GT(misses(places), 3 * side * side);
  EXPECT_LT(misses(order.corners), 2 * side * side);
}

TEST(TriangleOrder, bears_meshes_without_triangles) {
  Mesh mesh;
  EXPECT_TRUE(triangle_order(mesh, {}).corners.empty());
  mesh.positions = {glm::vec3(0.0f)};
  mesh.normals = {glm::vec3(0.0f, 0.0f, 1.0f)};
  mesh.primitives = {{0, 0, 0}};
  EXPECT_EQ(triangle_order(mesh, {true}).first_at.size(), 1u);
  Mesh some = torn_square(false);
  some.primitives.push_back({0, 0, 0});
  EXPECT_EQ(triangle_order(some, {true, true, true}).corners.size(), some.indices.size());
}

}  // namespace
}  // namespace penumbra
