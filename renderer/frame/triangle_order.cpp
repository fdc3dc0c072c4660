#include "renderer/frame/triangle_order.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "renderer/frame/closed_bodies.h"
#include "renderer/scene/scene.h"

namespace penumbra {
namespace {

using Indices = std::vector<std::uint32_t>;

template <class T>
void add_stream(std::vector<meshopt_Stream>& streams, const std::vector<T>& list) {
  if (!list.empty()) streams.push_back({list.data(), sizeof(T), sizeof(T)});
}

/// Triangles of a list by their corners, and by their place among such with the same.
Indices sorted(std::span<const std::uint32_t> corners) {
  Indices triangles(corners.size() / 3);
  std::iota(triangles.begin(), triangles.end(), 0u);
  std::stable_sort(triangles.begin(), triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto first = corners.subspan(std::size_t{a} * 3, 3);
    const auto second = corners.subspan(std::size_t{b} * 3, 3);
    return std::lexicographical_compare(first.begin(), first.end(), second.begin(), second.end());
  });
  return triangles;
}

/// Numbers vertices by their first use in a list, so that what is done with them takes as long as
/// the list is, however large the mesh.
class Numbers {
 public:
  explicit Numbers(std::size_t vertices) : number_(vertices) {}

  /// Returns how many there are.
  std::size_t replace(Indices& list) {
    for (std::uint32_t& vertex : list) {
      if (number_[vertex] == 0) {
        used_.push_back(vertex);
        number_[vertex] = static_cast<std::uint32_t>(used_.size());
      }
      vertex = number_[vertex] - 1;
    }
    const std::size_t count = used_.size();
    for (const std::uint32_t vertex : used_) number_[vertex] = 0;
    used_.clear();
    return count;
  }

 private:
  Indices number_;  ///< from one on; 0 has none
  Indices used_;
};

/// Vertices that a first-in, first-out cache does not find.
std::size_t misses(const Indices& corners, std::size_t vertices) {
  constexpr unsigned cached = 256;
  return meshopt_analyzeVertexCache(corners.data(), corners.size(), vertices, cached, 0, 0)
      .vertices_transformed;
}

/// The order in which triangles follow their neighbours; theirs where that saves less than a
/// quarter of what is asked for.
Indices neighbours_together(Indices places, Numbers& numbers) {
  const std::size_t count = numbers.replace(places);
  Indices ordered(places.size());
  meshopt_optimizeVertexCache(ordered.data(), places.data(), places.size(), count);
  if (4 * misses(ordered, count) > 3 * misses(places, count)) {
    Indices same(places.size() / 3);
    std::iota(same.begin(), same.end(), 0u);
    return same;
  }
  // It hands back corners, not which triangle they were.
  const Indices before = sorted(places), after = sorted(ordered);
  Indices triangles(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) triangles[after[i]] = before[i];
  return triangles;
}

/// By triangle of each primitive, whether it belongs to a closed body.
std::vector<std::vector<bool>> closed_triangles(const Mesh& mesh, const Indices& places,
                                                const std::vector<bool>& solid) {
  Indices corners;
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const auto first = places.begin() + mesh.primitives[p].first_index;
    if (solid[p]) corners.insert(corners.end(), first, first + mesh.primitives[p].index_count);
  }
  const std::vector<bool> found = in_closed_bodies(mesh.positions, corners);
  auto next = found.begin();
  std::vector<std::vector<bool>> closed;
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    auto& own = closed.emplace_back(mesh.primitives[p].index_count / 3);
    if (!solid[p]) continue;
    std::copy_n(next, own.size(), own.begin());
    next += static_cast<std::ptrdiff_t>(own.size());
  }
  return closed;
}

}  // namespace

TriangleOrder triangle_order(const Mesh& mesh, const std::vector<bool>& solid) {
  const std::size_t vertices = mesh.positions.size();
  TriangleOrder order;
  order.first_at.resize(vertices);
  std::iota(order.first_at.begin(), order.first_at.end(), 0u);
  if (mesh.indices.empty()) {
    order.first.resize(mesh.primitives.size());
    order.closed.resize(mesh.primitives.size());
    return order;
  }

  std::vector<meshopt_Stream> streams;
  add_stream(streams, mesh.positions);
  Indices places(mesh.indices.size());
  meshopt_generateShadowIndexBufferMulti(places.data(), mesh.indices.data(), places.size(),
                                         vertices, streams.data(), streams.size());
  for (std::size_t i = 0; i < places.size(); ++i) order.first_at[mesh.indices[i]] = places[i];
  add_stream(streams, mesh.normals);
  add_stream(streams, mesh.uvs);
  add_stream(streams, mesh.colors);
  Indices welded(places.size());
  meshopt_generateShadowIndexBufferMulti(welded.data(), mesh.indices.data(), welded.size(),
                                         vertices, streams.data(), streams.size());

  const auto closed = closed_triangles(mesh, places, solid);
  Numbers numbers(vertices);
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const std::uint32_t first = mesh.primitives[p].first_index;
    order.first.push_back(order.corners.size());
    for (const bool in_body : {true, false}) {
      Indices starts, own;
      for (std::size_t t = 0; t < closed[p].size(); ++t) {
        if (closed[p][t] != in_body) continue;
        const auto start = static_cast<std::uint32_t>(first + 3 * t);
        starts.push_back(start);
        own.insert(own.end(), places.begin() + start, places.begin() + start + 3);
      }
      if (in_body) order.closed.push_back(static_cast<std::uint32_t>(own.size()));
      for (const std::uint32_t t : neighbours_together(own, numbers))
        for (std::uint32_t k = 0; k < 3; ++k) order.corners.push_back(welded[starts[t] + k]);
    }
  }
  return order;
}

}  // namespace penumbra
