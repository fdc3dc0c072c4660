#include <algorithm>
#include <limits>
#include <optional>

#include "renderer/shadow_maps/views/light_view.h"
#include "renderer/shadow_maps/views/warp.h"

namespace penumbra::shadow_maps {
namespace {

bool follows_camera(const Light& light, const ParameterValues& parameters) {
  return is_at_infinity(light) && choice_of(parameters, "focus") == "seen";
}

/// For a light that shines around and stands far outside of the scene: one view instead of six.
std::optional<AimedView> aimed_view(const Light& light, const Bounds& scene_box) {
  if (!has_six_views(light)) return std::nullopt;
  return view_of_box(scene_box, light.position);
}

bool has_one_view(const Light& light, const Bounds& scene_box) {
  return !has_six_views(light) || aimed_view(light, scene_box);
}

std::vector<shader::MapView> fit_single(const ViewFitting& fitting) {
  const WorldLight& light = fitting.light;
  if (follows_camera(*light.source, fitting.parameters))
    return fit_warped(fitting,
                      [](const WarpInput&) { return std::numeric_limits<double>::infinity(); });
  const double widen = 1.0 / (1.0 - 2.0 * guard_share(fitting.use, fitting.size));
  std::vector<shader::MapView> views;
  if (is_at_infinity(*light.source)) {
    const ViewAxes axes{light.direction, light.up};
    const Bounds bounds = bounds_along(covered_box(fitting.scene, fitting.fit), axes);
    const glm::dvec3 center = bounds.center();
    const double half = std::max(0.5 * std::max(bounds.size().x, bounds.size().y), 1e-6) * widen;
    const glm::dvec3 origin =
        center.x * axes.right() + center.y * axes.up + bounds.low.z * axes.forward;
    views.push_back(make_view(origin, axes, half, false, fitting.size));
  } else if (const auto aimed = aimed_view(*light.source, fitting.scene_box)) {
    views = {make_view(light.position, aimed->axes, aimed->tangent * widen, true, fitting.size)};
  } else {
    views = views_around(light, widen, fitting.size);
  }
  fit_ranges(views, fitting.scene, fitting.fit, fitting.use.common_range);
  return views;
}

}  // namespace

Layout describe_single();
Layout describe_single() {
  const Parameter focus = choice(
      "focus", "scene", {"scene", "seen"},
      "What a directional light's view covers: the whole scene, or what the camera sees of it.");
  return {.id = "single",
          .meaning =
              "one view over the light's cone or the scene, six around a point light among things",
          .parameters = {focus},
          .serves = {LightKind::spot, LightKind::directional, LightKind::point},
          .view_count =
              [](const TechniqueInput& input) {
                return has_one_view(input.light, input.scene_box) ? 1u : 6u;
              },
          .fit = fit_single,
          .warps = follows_camera};
}

}  // namespace penumbra::shadow_maps
