#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <utility>
#include <vector>

namespace penumbra {

/// A corner of a triangle before its place is rounded.
struct FineVertex {
  glm::dvec3 position;  ///< world
  glm::vec3 normal;     ///< need not be unit
  glm::vec2 uv;
  glm::vec4 color;
};

/// Splits triangles that pass the origin much closer than they are long: their corners are far away
/// and so are coarse floats, which would lean the whole triangle. Whether an edge is split depends
/// on its ends alone, and where does not on their order, so that triangles that shared an edge
/// still do.
class TriangleSplitter {
 public:
  using Triangle = std::array<std::uint32_t, 3>;
  /// The vertex of an index, as it was before rounding.
  using Corner = std::function<FineVertex(std::uint32_t)>;

  /// Edges up to `short_edge`, m, stay whole. New vertices get indices from `next_index` on.
  TriangleSplitter(double short_edge, std::uint32_t next_index, Corner corner);

  /// The parts of a triangle, wound as it is; itself where no edge is too long.
  std::vector<Triangle> split(const Triangle& triangle);
  /// In the order of their indices.
  const std::vector<FineVertex>& new_vertices() const { return new_vertices_; }

 private:
  FineVertex vertex(std::uint32_t index) const;
  double excess(const FineVertex& a, const FineVertex& b) const;
  std::uint32_t middle_of(std::uint32_t a, std::uint32_t b);

  double short_edge_;
  std::uint32_t next_index_;
  Corner corner_;
  std::vector<FineVertex> new_vertices_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

}  // namespace penumbra
