#include "renderer/reference/hierarchy.h"

#include <gtest/gtest.h>

#include <random>

namespace penumbra::reference {
namespace {

std::vector<Triangle> random_triangles(std::size_t count) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<float> place(-10.0f, 10.0f), size(-0.5f, 0.5f);
  std::vector<Triangle> triangles(count);
  for (Triangle& triangle : triangles) {
    const glm::vec3 middle(place(generator), place(generator), place(generator));
    for (glm::vec3& corner : triangle)
      corner = middle + glm::vec3(size(generator), size(generator), size(generator));
  }
  return triangles;
}

bool holds(const Node& node, const glm::vec3& point) {
  return glm::all(glm::lessThanEqual(node.low, point)) &&
         glm::all(glm::greaterThanEqual(node.high, point));
}

TEST(Hierarchy, HoldsEveryTriangleInOneLeaf) {
  const auto triangles = random_triangles(500);
  const auto nodes = build_hierarchy(triangles);
  ASSERT_EQ(nodes.size(), 2 * triangles.size() - 1);
  std::vector<int> seen(triangles.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].triangle < 0) continue;
    ++seen[static_cast<std::size_t>(nodes[i].triangle)];
    EXPECT_EQ(nodes[i].next, i + 1);
  }
  EXPECT_EQ(seen, std::vector<int>(triangles.size(), 1));
}

TEST(Hierarchy, EnclosesInEveryBoxAllThatStandsBelowIt) {
  const auto triangles = random_triangles(300);
  const auto nodes = build_hierarchy(triangles);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    ASSERT_GT(nodes[i].next, i);
    ASSERT_LE(nodes[i].next, nodes.size());
    for (std::size_t k = i; k < nodes[i].next; ++k) {
      if (nodes[k].triangle < 0) continue;
      for (const glm::vec3& corner : triangles[static_cast<std::size_t>(nodes[k].triangle)])
        ASSERT_TRUE(holds(nodes[i], corner));
    }
  }
}

TEST(Hierarchy, LeavesAsideAllButFewBoxesForAPoint) {
  const auto triangles = random_triangles(4000);
  const auto nodes = build_hierarchy(triangles);
  std::size_t visited = 0;
  for (std::size_t i = 0; i < nodes.size(); ++visited)
    i = holds(nodes[i], glm::vec3(1.0f, 2.0f, 3.0f)) ? i + 1 : nodes[i].next;
  EXPECT_LT(visited, 200u);
}

TEST(Hierarchy, StaysShallowWhereAllTrianglesAreEqual) {
  const std::vector<Triangle> triangles(
      10000, Triangle{glm::vec3(0.0f), glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)});
  const auto nodes = build_hierarchy(triangles);
  ASSERT_EQ(nodes.size(), 19999u);
  std::size_t depth = 0;
  for (std::size_t i = 0; nodes[i].triangle < 0; ++i) ++depth;
  EXPECT_LE(depth, 15u);
}

TEST(Hierarchy, IsEmptyWithoutTriangles) {
  EXPECT_TRUE(build_hierarchy({}).empty());
}

}  // namespace
}  // namespace penumbra::reference
