#include "renderer/frame/split_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace penumbra {
namespace {

using Triangle = TriangleSplitter::Triangle;
constexpr double short_edge = 10.0;

/// A square on the plane z = -1, `half` to each side, of two triangles that have no vertex in
/// common.
struct Square {
  explicit Square(double half) {
    for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1),
                                    glm::dvec2(-1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)})
      vertices.push_back({glm::dvec3(half * corner, -1.0),
                          {0.0f, 0.0f, 1.0f},
                          glm::vec2(corner),
                          glm::vec4(1.0f)});
  }
  /// All parts; `vertices` has their corners then.
  std::vector<Triangle> split() {
    const auto corner = [&](std::uint32_t index) { return vertices[index]; };
    TriangleSplitter splitter(short_edge, 6, corner);
    std::vector<Triangle> parts;
    for (const Triangle& whole : {Triangle{0, 1, 2}, Triangle{3, 4, 5}})
      for (const Triangle& part : splitter.split(whole)) parts.push_back(part);
    const std::vector<FineVertex> added = splitter.new_vertices();
    vertices.insert(vertices.end(), added.begin(), added.end());
    return parts;
  }
  glm::vec3 rounded(std::uint32_t index) const { return glm::vec3(vertices[index].position); }

  std::vector<FineVertex> vertices;
};

TEST(TriangleSplitter, keeps_what_floats_bear) {
  Square square(3.0);
  EXPECT_EQ(square.split(), (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(TriangleSplitter, covers_the_same_ground_with_edges_no_longer_than_half_their_distance) {
  Square square(1e8);
  const std::vector<Triangle> parts = square.split();
  EXPECT_LT(parts.size(), 3000u);
  double area = 0.0;
  for (const Triangle& part : parts) {
    const glm::dvec3 a = square.vertices[part[0]].position, b = square.vertices[part[1]].position,
                     c = square.vertices[part[2]].position;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    EXPECT_GT(normal.z, 0.0) << "turned over";
    area += 0.5 * normal.z;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      const double nearest = std::min({glm::length(from), glm::length(to)});
      EXPECT_LE(glm::length(to - from), std::max(short_edge, 0.5 * nearest) * 1.0000001);
    }
  }
  EXPECT_NEAR(area, 4e16, 4e7);
}

TEST(TriangleSplitter, leaves_no_gap_between_triangles_that_shared_an_edge) {
  Square square(1e6);
  // Every edge within the square has a part on either side, by its rounded ends.
  const auto before = [](const glm::vec3& a, const glm::vec3& b) {
    return std::lexicographical_compare(&a.x, &a.x + 3, &b.x, &b.x + 3);
  };
  const auto pair_before = [&](const auto& p, const auto& q) {
    return before(p.first, q.first) || (!before(q.first, p.first) && before(p.second, q.second));
  };
  std::map<std::pair<glm::vec3, glm::vec3>, int, decltype(pair_before)> sides(pair_before);
  for (const Triangle& part : square.split())
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3 a = square.rounded(part[k]), b = square.rounded(part[(k + 1) % 3]);
      sides[before(a, b) ? std::pair(a, b) : std::pair(b, a)] += before(a, b) ? 1 : -1;
    }
  for (const auto& [edge, balance] : sides) {
    const auto on_rim = [&](int axis) {
      return std::abs(edge.first[axis]) == 1e6f && edge.first[axis] == edge.second[axis];
    };
    EXPECT_EQ(std::abs(balance), on_rim(0) || on_rim(1) ? 1 : 0);
  }
}

}  // namespace
}  // namespace penumbra
