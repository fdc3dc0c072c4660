#include "renderer/shadow_maps/views/seen.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/scene/convex_clip.h"
#include "renderer/shadow_maps/views/light_view.h"

namespace penumbra::shadow_maps {

double depth_of(const CameraMatrices& camera, const glm::dvec3& point) {
  return glm::dot(point - camera.position, camera.direction);
}

namespace {

/// The half-spaces around a light's cone; none where its rays are parallel or spread too wide.
std::vector<HalfSpace> cone_sides(const WorldLight& light) {
  if (!cone_of(*light.source) || has_six_views(*light.source)) return {};
  const auto sides = side_planes(glm::dmat4(views_around(light, 1.0, 1.0)[0].clip_from_world));
  return {sides.begin(), sides.end()};
}

/// The half-spaces that enclose what the camera sees of a slice; `far` may be infinite.
std::vector<HalfSpace> sides_of(const CameraMatrices& camera, const Slice& slice) {
  const auto sides = side_planes(camera.clip_from_world);
  std::vector<HalfSpace> planes(sides.begin(), sides.end());
  const double here = glm::dot(camera.position, camera.direction);
  planes.emplace_back(camera.direction, -here - slice.near);
  if (std::isfinite(slice.far)) planes.emplace_back(-camera.direction, here + slice.far);
  return planes;
}

}  // namespace

std::array<glm::dvec3, 8> corners_of(const CameraMatrices& camera, const Slice& slice) {
  constexpr std::array<glm::dvec2, 4> around{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::array<glm::dvec3, 8> corners;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const auto at = [&](double z) {
      const glm::dvec4 point = camera.world_from_clip * glm::dvec4(around[i], z, 1.0);
      return glm::dvec3(point) / point.w;
    };
    const glm::dvec3 first = at(1.0);  // the near plane: depth is reversed
    const glm::dvec3 step = at(0.5) - first;
    const double rise = glm::dot(step, camera.direction);
    for (std::size_t end = 0; end < 2; ++end) {
      const double depth = end == 0 ? slice.near : slice.far;
      corners[4 * end + i] = first + step * ((depth - depth_of(camera, first)) / rise);
    }
  }
  return corners;
}

std::vector<glm::dvec3> reached_corners(const CameraMatrices& camera, const Slice& slice,
                                        const WorldLight& light) {
  const auto cone = cone_sides(light);
  if (cone.empty() && std::isfinite(slice.far)) {
    const auto corners = corners_of(camera, slice);
    return {corners.begin(), corners.end()};
  }
  if (cone.empty()) {
    const auto corners = near_corners(camera);
    return {corners.begin(), corners.end()};
  }
  auto sides = sides_of(camera, slice);
  sides.insert(sides.end(), cone.begin(), cone.end());
  return body_corners(sides);
}

void visit_seen(const ViewFitting& fitting, const Slice& slice,
                const std::function<void(const glm::dvec3&)>& visit) {
  auto sides = sides_of(fitting.camera, slice);
  const auto cone = cone_sides(fitting.light);
  sides.insert(sides.end(), cone.begin(), cone.end());
  const auto own = reached_corners(fitting.camera, slice, fitting.light);
  for (const Bounds& receiver : fitting.fit.receivers) {
    const Bounds box = fitting.scene.near_part(receiver);
    if (box.empty()) continue;
    visit_clipped_corners(box, sides, visit);
    for (const glm::dvec3& corner : own)
      if (contains(box, corner)) visit(corner);
  }
}

Slice visible_slice(const ViewFitting& fitting) {
  const double nearest = depth_of(fitting.camera, near_corners(fitting.camera)[0]);
  Slice seen{std::numeric_limits<double>::infinity(), nearest};
  visit_seen(fitting, {nearest, std::numeric_limits<double>::infinity()},
             [&](const glm::dvec3& point) {
               const double depth = depth_of(fitting.camera, point);
               seen.near = std::min(seen.near, depth);
               seen.far = std::max(seen.far, depth);
             });
  seen.near = std::clamp(seen.near, nearest, seen.far);
  // Ratios of depths need a beginning before 0.
  seen.far = std::max(seen.far, 1e-6);
  seen.near = std::max(seen.near, 1e-4 * seen.far);
  return seen;
}

}  // namespace penumbra::shadow_maps
