#pragma once

#include <optional>

#include "renderer/frame/prepare_context.h"

namespace penumbra::shadow_volumes {

/// The part of the near plane that is seen, and the light: what z-pass must know of the camera.
class NearPlane {
 public:
  explicit NearPlane(const PrepareContext& context);

  /// Projects casters from the light onto the near plane, as the camera sees it; what is not
  /// between the two is clipped. Empty where the light lies in the plane.
  std::optional<glm::mat4> near_from_caster() const;

  /// False only if no shadow of anything within the box reaches the part of the near plane that is
  /// seen: some plane parts the box from the pyramid of light and near plane.
  bool may_be_in_shadow_of(const glm::vec3& low, const glm::vec3& high) const;

 private:
  glm::dmat4 clip_from_world_;
  glm::dvec4 light_;                 ///< homogeneous, world
  glm::dvec4 plane_;                 ///< positive behind the near plane, seen from the camera
  std::vector<glm::dvec4> pyramid_;  ///< inside positive
};

}  // namespace penumbra::shadow_volumes
