#pragma once

#include <array>
#include <glm/glm.hpp>

#include "renderer/scene/scene.h"

/// Matrices are named target-from-source and flip Y, so that counter-clockwise stays
/// counter-clockwise in Vulkan's picture, which has Y down.
namespace penumbra {

/// View with `forward` along -Z; `up` is bent where it is parallel to forward.
glm::dmat4 view_from_world(const glm::dvec3& position, const glm::dvec3& forward,
                           const glm::dvec3& up);

/// Reversed depth (1 at the near plane, 0 at infinity). `vertical_fov` in degrees.
glm::dmat4 clip_from_view_perspective(double vertical_fov, double aspect, double near_plane);

/// Reversed depth (1 at near, 0 at far). Sizes in metres.
glm::dmat4 clip_from_view_orthographic(double width, double height, double near_plane,
                                       double far_plane);

/// Unit vector across `direction`, as near to `wanted` as can be.
glm::dvec3 across(const glm::dvec3& direction, const glm::dvec3& wanted);

struct CameraMatrices {
  glm::dmat4 clip_from_world{1.0};
  /// Of clip space (x, y, 1, 1) is a place on the near plane, and (x, y, 0, 1) of a perspective
  /// view the direction through x, y, whatever becomes of depth beyond the near plane.
  glm::dmat4 world_from_clip{1.0};
  glm::dvec3 position{0.0};   ///< world, moved by -origin
  glm::dvec3 direction{0.0};  ///< unit
  double near_plane = 0.0;    ///< m
  bool ends = false;          ///< depth has an end, behind all that is seen
};

/// Corners of the rectangle that the picture shows of the near plane, in a round.
std::array<glm::dvec3, 4> near_corners(const CameraMatrices& camera);

/// `far` is where the depth of orthographic cameras ends, metres along the view beyond the near
/// plane; perspective views have no end.
CameraMatrices camera_matrices(const Camera& camera, const glm::dvec3& origin, double aspect,
                               double far);

/// A camera's matrices where visible things lie in these boxes. Depth is a float: it is counted
/// over what is seen alone where the view has no perspective, or where all that is seen is so far
/// away that nothing else tells it apart.
CameraMatrices matrices_seeing(const Camera& camera, const glm::dvec3& origin, double aspect,
                               const std::vector<Bounds>& boxes);

}  // namespace penumbra
