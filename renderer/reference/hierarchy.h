#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

/// Exact visibility between surfaces and points of a light: a bounding volume hierarchy over the
/// casters' triangles, and the pass that walks it.
namespace penumbra::reference {

using Triangle = std::array<glm::vec3, 3>;

/// A box of the hierarchy. Nodes are in depth-first order: the first child follows its parent,
/// and `next` is where a walk goes on that leaves this box aside. A walk may therefore start at any
/// node and visit a part of the array only.
struct Node {
  glm::vec3 low;
  std::uint32_t next;
  glm::vec3 high;
  std::int32_t triangle;  ///< of a leaf, otherwise -1
};
static_assert(sizeof(Node) == 32, "two texels of four words");

/// Hierarchy over `triangles`, one in each leaf, by the surface area heuristic over 16 bins (Wald
/// 2007). 2n - 1 nodes, none for no triangles. The order of equal input is equal.
std::vector<Node> build_hierarchy(std::span<const Triangle> triangles);

}  // namespace penumbra::reference
