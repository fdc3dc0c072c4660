#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace penumbra::scenes {

/// Share of each of up to four corners in a point where edges cross; others are zero.
using CornerShares = std::array<std::pair<std::uint32_t, double>, 4>;

struct Triangulation {
  /// Three corners per triangle, counter-clockwise as the polygon. Numbers from the count of
  /// corners upwards are crossings, in the order in which they were reported.
  std::vector<std::uint32_t> corners;
  bool crosses_itself = false;
};

/// Triangles of a polygon: concave, with holes that are joined to its border by doubled edges, with
/// corners on a line or twice at a place, bent out of its plane. What it winds around is inside
/// (the nonzero rule), so that one that crosses itself keeps all its parts. Every corner stays
/// where it is; `crossing` hears of each corner added where edges cross. Three corners are a
/// triangle wherever they lie; more of which less than three differ give nothing.
Triangulation triangulate(std::span<const glm::dvec3> polygon,
                          const std::function<void(const CornerShares&)>& crossing);

}  // namespace penumbra::scenes
