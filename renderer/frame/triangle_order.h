#pragma once

#include <cstdint>
#include <vector>

namespace penumbra {

struct Mesh;

/// A mesh's triangles as they are drawn.
struct TriangleOrder {
  /// Corners of one primitive's triangles after the other's, turned as they were. Vertices that are
  /// alike in all that the mesh has of them are one. Where the given order asks for many
  /// corners anew, triangles follow their neighbours: lavapipe runs the vertex stage again for what
  /// its cache of 256 lost, and for each 341 triangles.
  std::vector<std::uint32_t> corners;
  /// By primitive: where its corners begin.
  std::vector<std::size_t> first;
  /// By primitive: how many of its corners, which come first, are those of closed bodies.
  std::vector<std::uint32_t> closed;
  /// By vertex: the first corner with the same position, which is all that shadows ask of it.
  std::vector<std::uint32_t> first_at;
};

/// `solid` by primitive: whether all of its triangles are there, without holes. Others leave what
/// they belong to open.
TriangleOrder triangle_order(const Mesh& mesh, const std::vector<bool>& solid);

}  // namespace penumbra
