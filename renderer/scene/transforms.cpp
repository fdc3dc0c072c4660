#include "renderer/scene/transforms.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "renderer/scene/convex_clip.h"

namespace penumbra {

glm::dvec3 across(const glm::dvec3& direction, const glm::dvec3& wanted) {
  const glm::dvec3 unit = glm::normalize(direction);
  glm::dvec3 side = wanted - glm::dot(wanted, unit) * unit;
  if (glm::length(side) < 1e-6 * std::max(1.0, glm::length(wanted))) {
    const glm::dvec3 other = std::abs(unit.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    side = other - glm::dot(other, unit) * unit;
  }
  return glm::normalize(side);
}

glm::dmat4 view_from_world(const glm::dvec3& position, const glm::dvec3& forward,
                           const glm::dvec3& up) {
  const glm::dvec3 f = glm::normalize(forward);
  const glm::dvec3 u = across(f, up);
  const glm::dvec3 r = glm::cross(f, u);
  glm::dmat4 view(1.0);
  for (int i = 0; i < 3; ++i) {
    view[i][0] = r[i];
    view[i][1] = u[i];
    view[i][2] = -f[i];
  }
  view[3] = glm::dvec4(-glm::dot(r, position), -glm::dot(u, position), glm::dot(f, position), 1.0);
  return view;
}

glm::dmat4 clip_from_view_perspective(double vertical_fov, double aspect, double near_plane) {
  const double f = 1.0 / std::tan(0.5 * vertical_fov * glm::pi<double>() / 180.0);
  glm::dmat4 clip(0.0);
  clip[0][0] = f / aspect;
  clip[1][1] = -f;
  clip[2][3] = -1.0;
  clip[3][2] = near_plane;
  return clip;
}

glm::dmat4 clip_from_view_orthographic(double width, double height, double near_plane,
                                       double far_plane) {
  glm::dmat4 clip(1.0);
  clip[0][0] = 2.0 / width;
  clip[1][1] = -2.0 / height;
  clip[2][2] = 1.0 / (far_plane - near_plane);
  clip[3][2] = far_plane / (far_plane - near_plane);
  return clip;
}

std::array<glm::dvec3, 4> near_corners(const CameraMatrices& camera) {
  constexpr std::array<glm::dvec2, 4> around{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::array<glm::dvec3, 4> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec4 corner = camera.world_from_clip * glm::dvec4(around[i], 1.0, 1.0);
    corners[i] = glm::dvec3(corner) / corner.w;
  }
  return corners;
}

CameraMatrices camera_matrices(const Camera& camera, const glm::dvec3& origin, double aspect,
                               double far) {
  CameraMatrices matrices;
  matrices.position = camera.position - origin;
  matrices.direction = glm::normalize(camera.target - camera.position);
  const glm::dmat4 view = view_from_world(matrices.position, matrices.direction, camera.up);
  matrices.clip_from_world =
      camera.projection == Projection::perspective
          ? clip_from_view_perspective(camera.vertical_fov, aspect, camera.near_plane) * view
          : clip_from_view_orthographic(camera.orthographic_height * aspect,
                                        camera.orthographic_height, camera.near_plane,
                                        camera.near_plane + far) *
                view;
  matrices.world_from_clip = glm::inverse(matrices.clip_from_world);
  matrices.near_plane = camera.near_plane;
  matrices.ends = camera.projection == Projection::orthographic;
  return matrices;
}

namespace {

/// Along the view, m from the camera.
struct SeenDepths {
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = -std::numeric_limits<double>::infinity();
  double reach = 0.0;  ///< farthest from where coordinates begin, m: floats are as coarse as that
};

SeenDepths seen_depths(const Camera& camera, const glm::dvec3& origin, double aspect,
                       const std::vector<Bounds>& boxes) {
  const CameraMatrices matrices = camera_matrices(camera, origin, aspect, 1.0);
  const auto sides = side_planes(matrices.clip_from_world);
  SeenDepths seen;
  for (const Bounds& box : boxes)
    visit_clipped_corners(box, sides, [&](const glm::dvec3& corner) {
      const double depth = glm::dot(corner - matrices.position, matrices.direction);
      seen.nearest = std::min(seen.nearest, depth);
      seen.farthest = std::max(seen.farthest, depth);
      seen.reach = std::max(seen.reach, glm::length(corner));
    });
  return seen;
}

/// Lets depth run from 1 at the near plane to 0 at `far` instead of at infinity.
void end_depth(CameraMatrices& matrices, double far) {
  const double span = far - matrices.near_plane;
  for (int column = 0; column < 4; ++column) {
    glm::dvec4& clip = matrices.clip_from_world[column];
    clip.z = (far * clip.z - matrices.near_plane * clip.w) / span;
  }
  matrices.ends = true;
}

}  // namespace

CameraMatrices matrices_seeing(const Camera& camera, const glm::dvec3& origin, double aspect,
                               const std::vector<Bounds>& boxes) {
  const SeenDepths seen = seen_depths(camera, origin, aspect, boxes);
  const bool perspective = camera.projection == Projection::perspective;
  // Nearer cameras lose little, and keep every bit.
  constexpr double far_away = 16.0;
  const double span = seen.farthest - seen.nearest;
  if (span < 0.0 || (perspective && seen.nearest < far_away * span))
    return camera_matrices(camera, origin, aspect, 1.0);
  // Corners are rounded, and what is flat has no depth of its own.
  const double margin = std::max({0.01 * span, 1e-4 * seen.farthest, 1e-5 * seen.reach});
  Camera fitted = camera;
  if (seen.nearest - margin > camera.near_plane) fitted.near_plane = seen.nearest - margin;
  const double behind_near = seen.farthest + margin - fitted.near_plane;
  const double depth = behind_near > margin ? behind_near : 1.0;
  CameraMatrices matrices = camera_matrices(fitted, origin, aspect, depth);
  if (perspective) end_depth(matrices, fitted.near_plane + depth);
  return matrices;
}

}  // namespace penumbra
