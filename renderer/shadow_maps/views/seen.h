#pragma once

#include <array>
#include <functional>

#include "renderer/shadow_maps/layout.h"

/// What the camera sees of what a light reaches: what layouts that follow the camera are fitted to.
namespace penumbra::shadow_maps {

/// Metres along the camera's direction, counted from the camera.
struct Slice {
  double near;
  double far;
  double depth() const { return far - near; }
};

/// Distance from the camera along its direction, m.
double depth_of(const CameraMatrices& camera, const glm::dvec3& point);

/// Corners of the slice's near and far end, four each.
std::array<glm::dvec3, 8> corners_of(const CameraMatrices& camera, const Slice& slice);

/// Corners of what a light may reach of a slice: of all of it, or of its part in a spot light's
/// cone. Those of the near end alone where the far end is infinite.
std::vector<glm::dvec3> reached_corners(const CameraMatrices& camera, const Slice& slice,
                                        const WorldLight& light);

/// Calls `visit` with points that span what the camera sees of the receivers in a slice, whose far
/// end may be infinite, within a spot light's cone.
void visit_seen(const ViewFitting& fitting, const Slice& slice,
                const std::function<void(const glm::dvec3&)>& visit);

/// From the nearest to the farthest receiver that the camera sees; never from 0.
Slice visible_slice(const ViewFitting& fitting);

}  // namespace penumbra::shadow_maps
