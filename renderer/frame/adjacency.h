#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/vulkan/memory.h"

namespace penumbra {

struct DrawRange;  // renderer/frame/gpu_scene.h

/// Triangles of one instance that volumes are made of in one way: a range of the adjacency indices.
struct AdjacencyGroup {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::uint32_t instance = 0;
  /// Every edge of every triangle has a neighbour that runs along it in the opposite direction, and
  /// no triangle has a reversed twin: the triangles enclose space, and those turned away from the
  /// light are enough to cast the shadow.
  bool closed = false;
  bool casts_shadow = true;
  glm::vec3 low{0.0f};  ///< box, world
  glm::vec3 high{0.0f};
};

/// Triangles with adjacency in the order of VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY: six
/// indices a triangle, corners at 0, 2 and 4 in the order of the plain index buffer, opposite
/// corners of the neighbours at 1, 3 and 5. Corners of equal world position within an instance
/// share one index, whatever their normals. An edge without neighbour names its own first corner
/// there. A triangle with two equal corners encloses nothing: it has no neighbours.
struct Adjacency {
  std::vector<std::uint32_t> indices;
  std::vector<AdjacencyGroup> groups;  ///< closed ones first; casters first in both kinds
  std::uint64_t open_edges = 0;
  std::uint64_t non_manifold_edges = 0;  ///< with more than two triangles
  std::uint64_t degenerate_triangles = 0;
};

/// Finds neighbours. Where more than two triangles share an edge, those that run along it in
/// opposite directions are paired first, and of these the ones with the closest normals (van
/// Sambeek 2007, 3.2.4); pairs are mutual, so that volumes stay closed.
Adjacency build_adjacency(std::span<const glm::vec3> positions,
                          std::span<const std::uint32_t> indices,
                          std::span<const DrawRange> ranges);

/// On the device: the index buffer is exactly twice as large as the scene's.
struct SceneAdjacency {
  Adjacency host;  ///< indices are freed after upload
  vulkan::Buffer indices;
};

}  // namespace penumbra
