#include <algorithm>
#include <cmath>

#include "renderer/shadow_maps/views/cascades.h"
#include "renderer/shadow_maps/views/light_view.h"

namespace penumbra::shadow_maps {
namespace {

/// Widened to powers of the fourth root of two, so that it stays as it is while the camera moves a
/// little.
Slice steady_slice(const Slice& seen) {
  return {std::exp2(std::floor(4.0 * std::log2(seen.near)) / 4.0),
          std::exp2(std::ceil(4.0 * std::log2(seen.far)) / 4.0)};
}

/// A square of the plane across the light's direction, m.
struct Square {
  glm::dvec2 center;
  double half;
};

/// Around all that is seen of the slice.
Square tight_square(const ViewFitting& fitting, const Slice& slice, const ViewAxes& axes) {
  Bounds seen;
  const auto add = [&](const glm::dvec3& point) {
    seen.add({glm::dot(point, axes.right()), glm::dot(point, axes.up), 0.0});
  };
  visit_seen(fitting, slice, add);
  if (seen.empty())
    for (const glm::dvec3& corner : corners_of(fitting.camera, slice)) add(corner);
  return {glm::dvec2(seen.center()), 0.5 * std::max(seen.size().x, seen.size().y)};
}

/// Around a sphere that holds the slice: of one size however the camera turns.
Square steady_square(const CameraMatrices& camera, const Slice& slice, const ViewAxes& axes) {
  const auto corners = corners_of(camera, slice);
  const auto distance_from_axis = [&](const glm::dvec3& point) {
    return glm::length(point - camera.position - depth_of(camera, point) * camera.direction);
  };
  const double a = distance_from_axis(corners[0]);
  const double b = distance_from_axis(corners[4]);
  const double depth =
      slice.depth() > 0.0
          ? std::clamp(0.5 * (slice.near + slice.far) + 0.5 * (b * b - a * a) / slice.depth(),
                       slice.near, slice.far)
          : slice.near;
  const glm::dvec3 center = camera.position + depth * camera.direction;
  const double radius =
      std::max(std::hypot(a, depth - slice.near), std::hypot(b, slice.far - depth));
  return {{glm::dot(center, axes.right()), glm::dot(center, axes.up)}, radius};
}

/// Moves the square's centre to whole texels, counted from a point of the scene that stays where it
/// is when the frame's origin does not.
void snap(Square& square, const ViewFitting& fitting, const ViewAxes& axes) {
  const glm::dvec3 origin = fitting.scene.origin();
  const glm::dvec2 fixed(glm::dot(origin, axes.right()), glm::dot(origin, axes.up));
  const double texel = 2.0 * square.half / fitting.size;
  square.center = glm::round((square.center + fixed) / texel) * texel - fixed;
}

std::vector<shader::MapView> fit_cascades(const ViewFitting& fitting) {
  const ParameterValues& parameters = fitting.parameters;
  const WorldLight& light = fitting.light;
  const bool steady = boolean_of(parameters, "cascade_snapping");
  const ViewAxes axes{light.direction, light.up};
  const Bounds covered = bounds_along(covered_box(fitting.scene, fitting.fit), axes);
  const double widen = 1.0 / (1.0 - 2.0 * guard_share(fitting.use, fitting.size));
  // The widest penumbra: of the highest caster on the lowest receiver.
  const double reach =
      fitting.use.follows_extent ? extent_radius(*light.source) * covered.size().z : 0.0;

  const Slice seen = visible_slice(fitting);
  const auto slices = cut_slices(steady ? steady_slice(seen) : seen, parameters);
  std::vector<shader::MapView> views;
  for (std::size_t i = 0; i + 1 < slices.size(); ++i) {
    const Slice& slice = slices[i];
    Square square =
        steady ? steady_square(fitting.camera, slice, axes) : tight_square(fitting, slice, axes);
    square.half = std::max(square.half, 1e-6);
    // Room for the filter; at most as much again for penumbrae.
    square.half = std::max(square.half * widen, std::min(square.half + reach, 2.0 * square.half));
    if (steady) snap(square, fitting, axes);
    const glm::dvec3 origin =
        square.center.x * axes.right() + square.center.y * axes.up + covered.low.z * axes.forward;
    shader::MapView view = make_view(origin, axes, square.half, false, fitting.size);
    set_choice(view, slices, i);
    views.push_back(view);
  }
  fit_ranges(views, fitting.scene, fitting.fit, fitting.use.common_range);
  return views;
}

std::vector<Parameter> cascade_parameters() {
  std::vector<Parameter> list = split_parameters();
  list.push_back(
      boolean("cascade_snapping", true,
              "Fit cascades to spheres and move them by whole texels, so that shadows do not crawl "
              "when the camera moves; otherwise fit them tightly to what is seen."));
  return list;
}

}  // namespace

Layout describe_cascaded();
Layout describe_cascaded() {
  return {.id = "cascaded",
          .meaning =
              "views of slices of what the camera sees, near ones finer, for directional "
              "lights",
          .parameters = cascade_parameters(),
          .serves = {LightKind::directional},
          .view_count = [](const TechniqueInput& input) { return cascade_count(input.parameters); },
          .fit = fit_cascades};
}

}  // namespace penumbra::shadow_maps
