#include "renderer/scene/convex_clip.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

std::vector<glm::dvec3> clip(const std::vector<glm::dvec3>& polygon, const HalfSpace& side) {
  std::vector<glm::dvec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3& a = polygon[i];
    const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
    const double inside_a = glm::dot(side, glm::dvec4(a, 1.0));
    const double inside_b = glm::dot(side, glm::dvec4(b, 1.0));
    if (inside_a >= 0.0) kept.push_back(a);
    if ((inside_a < 0.0) != (inside_b < 0.0))
      kept.push_back(glm::mix(a, b, inside_a / (inside_a - inside_b)));
  }
  return kept;
}

void visit_clipped_corners(const Bounds& box, std::span<const HalfSpace> sides,
                           const std::function<void(const glm::dvec3&)>& visit) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double level : {box.low[axis], box.high[axis]}) {
      std::vector<glm::dvec3> polygon(4);
      for (std::size_t corner = 0; corner < 4; ++corner) {
        polygon[corner][axis] = level;
        polygon[corner][u] = corner == 1 || corner == 2 ? box.high[u] : box.low[u];
        polygon[corner][v] = corner >= 2 ? box.high[v] : box.low[v];
      }
      for (const HalfSpace& side : sides) polygon = clip(polygon, side);
      for (const glm::dvec3& point : polygon) visit(point);
    }
  }
}

Bounds common_part(const Bounds& box, std::span<const HalfSpace> sides,
                   std::span<const glm::dvec3> corners) {
  Bounds part;
  visit_clipped_corners(box, sides, [&](const glm::dvec3& point) { part.add(point); });
  for (const glm::dvec3& corner : corners)
    if (contains(box, corner)) part.add(corner);
  return part;
}

std::vector<glm::dvec3> body_corners(std::span<const HalfSpace> sides) {
  std::vector<HalfSpace> unit;
  for (const HalfSpace& side : sides) unit.push_back(side / glm::length(glm::dvec3(side)));
  std::vector<glm::dvec3> corners;
  const auto add = [&](const HalfSpace& a, const HalfSpace& b, const HalfSpace& c) {
    const glm::dvec3 bc = glm::cross(glm::dvec3(b), glm::dvec3(c));
    const double volume = glm::dot(glm::dvec3(a), bc);
    if (std::abs(volume) < 1e-12) return;  // two of them are parallel, or all meet in a line
    const glm::dvec3 point = -(a.w * bc + b.w * glm::cross(glm::dvec3(c), glm::dvec3(a)) +
                               c.w * glm::cross(glm::dvec3(a), glm::dvec3(b))) /
                             volume;
    const double rounding = 1e-9 * (1.0 + glm::length(point));
    for (const HalfSpace& side : unit)
      if (glm::dot(side, glm::dvec4(point, 1.0)) < -rounding) return;
    corners.push_back(point);
  };
  for (std::size_t i = 0; i < unit.size(); ++i)
    for (std::size_t j = i + 1; j < unit.size(); ++j)
      for (std::size_t k = j + 1; k < unit.size(); ++k) add(unit[i], unit[j], unit[k]);
  return corners;
}

std::array<HalfSpace, 4> side_planes(const glm::dmat4& clip_from_world) {
  const glm::dmat4 rows = glm::transpose(clip_from_world);
  return {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]};
}

HalfSpace near_plane(const glm::dmat4& clip_from_world) {
  const glm::dmat4 rows = glm::transpose(clip_from_world);
  return rows[3] - rows[2];
}

bool may_touch(const Bounds& box, std::span<const HalfSpace> sides) {
  for (const HalfSpace& side : sides) {
    const glm::dvec3 innermost(side.x > 0.0 ? box.high.x : box.low.x,
                               side.y > 0.0 ? box.high.y : box.low.y,
                               side.z > 0.0 ? box.high.z : box.low.z);
    if (glm::dot(side, glm::dvec4(innermost, 1.0)) < 0.0) return false;
  }
  return true;
}

bool may_touch(const glm::dvec3& center, double radius, std::span<const HalfSpace> sides) {
  return std::all_of(sides.begin(), sides.end(), [&](const HalfSpace& side) {
    return glm::dot(side, glm::dvec4(center, 1.0)) >= -radius * glm::length(glm::dvec3(side));
  });
}

bool contains(const Bounds& box, const glm::dvec3& point) {
  return glm::all(glm::lessThanEqual(box.low, point)) &&
         glm::all(glm::lessThanEqual(point, box.high));
}

}  // namespace penumbra
