#include "renderer/shadow_volumes/near_plane.h"

#include <cmath>

#include "renderer/scene/convex_clip.h"

namespace penumbra::shadow_volumes {

NearPlane::NearPlane(const PrepareContext& context)
    : clip_from_world_(context.camera.clip_from_world), light_(context.light.center) {
  plane_ = penumbra::near_plane(clip_from_world_);

  // Planes through the light and the sides of the near rectangle, and the near plane itself, all
  // turned so that the pyramid is inside.
  const std::array<glm::dvec3, 4> corners = near_corners(context.camera);
  glm::dvec3 middle(0.0);
  for (const glm::dvec3& corner : corners) middle += 0.25 * corner;
  const auto add = [&](glm::dvec4 plane, const glm::dvec4& inside) {
    if (glm::dot(plane, inside) < 0.0) plane = -plane;
    const double length = glm::length(glm::dvec3(plane));
    if (length > 0.0) pyramid_.push_back(plane / length);
  };
  const double light_height = glm::dot(plane_, light_);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 a = corners[i];
    const glm::dvec3 b = corners[(i + 1) % 4];
    const glm::dvec3 to_light = glm::dvec3(light_) - light_.w * a;
    const glm::dvec3 normal = glm::cross(b - a, to_light);
    // A light in the near plane makes the pyramid flat: then it parts nothing.
    if (light_height != 0.0) add(glm::dvec4(normal, -glm::dot(normal, a)), glm::dvec4(middle, 1.0));
  }
  if (light_height != 0.0) add(plane_, light_);
}

std::optional<glm::mat4> NearPlane::near_from_caster() const {
  const double light_height = glm::dot(plane_, light_);
  if (light_height == 0.0) return std::nullopt;
  // A point y goes to y h(light) - light h(y), with h the height over the plane: it is on the line
  // from the light through y, and its own height is zero.
  const glm::dvec4 light = clip_from_world_ * light_;
  const double side = light_height > 0.0 ? 1.0 : -1.0;
  glm::dmat4 near_from_caster = light_height * clip_from_world_ - glm::outerProduct(light, plane_);
  near_from_caster *= side / std::abs(light_height);
  // Depth is the caster's height over the plane on the light's side, so small that only its sign
  // clips.
  const glm::dvec4 height = plane_ * (side * 1e-9 / glm::length(plane_));
  for (int column = 0; column < 4; ++column) near_from_caster[column][2] = height[column];
  return glm::mat4(near_from_caster);
}

bool NearPlane::may_be_in_shadow_of(const glm::vec3& low, const glm::vec3& high) const {
  // Rounding of the box must not part what touches.
  const double margin = 1e-6 * glm::length(glm::dvec3(high) - glm::dvec3(low));
  for (const glm::dvec4& plane : pyramid_) {
    const glm::dvec3 farthest(plane.x > 0.0 ? high.x : low.x, plane.y > 0.0 ? high.y : low.y,
                              plane.z > 0.0 ? high.z : low.z);
    if (glm::dot(plane, glm::dvec4(farthest, 1.0)) < -margin) return false;
  }
  return true;
}

}  // namespace penumbra::shadow_volumes
