#pragma once

#include <optional>

#include "renderer/frame/prepare_context.h"

namespace penumbra::shadow_volumes {

/// What bounds the shadows that a camera can see of a light.
class VolumeBounds {
 public:
  /// `light_radius` of the sphere around the light, m; tangent of the angle when directional.
  VolumeBounds(const PrepareContext& context, double light_radius);

  /// False only where nothing within the box can lie between the light and a visible surface that
  /// it lights: the box lies outside the spot's cone or range, or outside a side plane of the view
  /// whose inside holds both the light and everything visible.
  bool may_shadow(const glm::vec3& low, const glm::vec3& high) const;

  /// Plane behind all visible surfaces and the near plane, seen along the way from the light
  /// through the box: xyz unit away from the light, w distance from the light (from the origin for
  /// a directional light). Empty where the box reaches behind the light.
  std::optional<glm::vec4> end_plane(const glm::vec3& low, const glm::vec3& high) const;

  /// Reversed depth just behind everything visible: where a far plane would be.
  float far_depth(const glm::dmat4& clip_from_world) const;

 private:
  const WorldLight& light_;
  double light_radius_;
  std::vector<glm::dvec4> planes_;  ///< of the view, pointing inwards, with the light inside
  Bounds receivers_;  ///< box around all parts of the scene in view and the near plane
};

}  // namespace penumbra::shadow_volumes
