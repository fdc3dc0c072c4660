#pragma once

#include <map>
#include <string>
#include <tuple>

#include "renderer/scene/scene.h"

namespace penumbra::scenes::test {

/// Empty where the mesh encloses volumes: every directed edge, by the positions at its ends,
/// belongs to exactly one triangle and its opposite to exactly one other. Otherwise says what is
/// wrong.
inline std::string leak_of(const Mesh& mesh) {
  using Point = std::tuple<float, float, float>;
  std::map<std::pair<Point, Point>, int> edges;
  const auto point = [&](std::uint32_t index) {
    const glm::vec3& p = mesh.positions[index];
    return Point{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
  };
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = point(mesh.indices[i + k]), b = point(mesh.indices[i + (k + 1) % 3]);
      if (a == b) return "a triangle with two equal corners";
      ++edges[{a, b}];
    }
  for (const auto& [edge, count] : edges) {
    if (count != 1) return "an edge that two triangles run along in the same direction";
    if (edges.count({edge.second, edge.first}) == 0) return "an edge with one triangle only";
  }
  return {};
}

/// Volume enclosed by the mesh; negative where triangles face inwards.
inline double volume_of(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
        c(mesh.positions[mesh.indices[i + 2]]);
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

}  // namespace penumbra::scenes::test
