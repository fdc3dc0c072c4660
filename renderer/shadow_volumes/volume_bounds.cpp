#include "renderer/shadow_volumes/volume_bounds.h"

#include <cmath>

#include "renderer/scene/convex_clip.h"

namespace penumbra::shadow_volumes {
namespace {

glm::dvec3 corner_of(const glm::dvec3& low, const glm::dvec3& high, int corner) {
  return {(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
          (corner & 4) != 0 ? high.z : low.z};
}

}  // namespace

VolumeBounds::VolumeBounds(const PrepareContext& context, double light_radius)
    : light_(context.light), light_radius_(light_radius) {
  const auto sides = side_planes(context.camera.clip_from_world);
  std::vector<HalfSpace> view(sides.begin(), sides.end());
  view.push_back(near_plane(context.camera.clip_from_world));
  for (const HalfSpace& plane : view)
    if (glm::dot(plane, light_.center) >= light_radius * glm::length(glm::dvec3(plane)))
      planes_.push_back(plane);
  for (const DrawRange& range : context.scene.ranges())
    if (may_touch(range.box(), sides)) receivers_.add(range.box());
  if (receivers_.empty()) return;
  // A view ray that starts behind the end of a volume would enter it through the end.
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const glm::dvec4 corner = context.camera.world_from_clip * glm::dvec4(x, y, 1.0, 1.0);
      receivers_.add(glm::dvec3(corner) / corner.w);
    }
}

bool VolumeBounds::may_shadow(const glm::vec3& low, const glm::vec3& high) const {
  if (receivers_.empty()) return false;
  if (!may_touch(Bounds{low, high}, planes_)) return false;
  const glm::dvec3 middle = 0.5 * (glm::dvec3(low) + glm::dvec3(high));
  // What hides a point of the light from a receiver is no farther than its radius from what hides
  // the centre.
  const double radius = 0.5 * glm::length(glm::dvec3(high) - glm::dvec3(low)) + light_radius_;
  return light_.may_reach(middle, radius);
}

float VolumeBounds::far_depth(const glm::dmat4& clip_from_world) const {
  double depth = 1.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 clip =
        clip_from_world * glm::dvec4(corner_of(receivers_.low, receivers_.high, corner), 1.0);
    if (clip.w > 0.0) depth = std::min(depth, clip.z / clip.w);
  }
  return static_cast<float>(0.999 * depth);
}

std::optional<glm::vec4> VolumeBounds::end_plane(const glm::vec3& low,
                                                 const glm::vec3& high) const {
  const glm::dvec3 from = light_.origin();
  const glm::dvec3 middle = 0.5 * (glm::dvec3(low) + glm::dvec3(high));
  if (glm::length(light_.to_center(middle)) <= 0.0) return std::nullopt;
  const glm::dvec3 axis = light_.ray_direction(middle);
  double end = -std::numeric_limits<double>::infinity();
  double nearest = -end;
  for (int corner = 0; corner < 8; ++corner) {
    end = std::max(end, glm::dot(corner_of(receivers_.low, receivers_.high, corner) - from, axis));
    const glm::dvec3 own = corner_of(low, high, corner) - from;
    end = std::max(end, glm::dot(own, axis));
    nearest = std::min(nearest, glm::dot(own, axis));
  }
  // A caster that nearly surrounds the light would send its corners far out sideways.
  if (!is_at_infinity(*light_.source) && nearest < 1e-3 * end) return std::nullopt;
  const double margin = 1e-3 * glm::length(receivers_.size()) + 1e-5 * std::abs(end);
  return glm::vec4(axis, end + margin);
}

}  // namespace penumbra::shadow_volumes
