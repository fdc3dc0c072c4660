#include <algorithm>
#include <cmath>

#include "renderer/shadow_maps/views/cascades.h"
#include "renderer/shadow_maps/views/warp.h"

namespace penumbra::shadow_maps {
namespace {

/// A view that is asked for bounds along axes, of samples in a slice.
shader::MapView asked_view(const glm::dvec3& origin, const ViewAxes& axes, const Slice& slice) {
  shader::MapView view = make_view(origin, axes, 1.0, false, 1.0);
  view.choice = {static_cast<float>(slice.near), static_cast<float>(slice.far), 0.0f, 0.0f};
  return view;
}

/// From the nearest to the farthest sample seen; of the boxes where there is none.
Slice sampled_slice(const ViewFitting& fitting) {
  const CameraMatrices& camera = fitting.camera;
  const ViewAxes axes{camera.direction, across(camera.direction, fitting.light.up)};
  const Slice boxes = visible_slice(fitting);
  const Bounds seen =
      fitting.seen_bounds({asked_view(camera.position, axes, {0.0, 1e30})}, true).front();
  if (seen.empty()) return boxes;
  return {std::clamp(seen.low.z, boxes.near, boxes.far),
          std::clamp(seen.high.z, boxes.near, boxes.far)};
}

/// What the boxes leave of a slice along axes from a place.
Bounds seen_boxes(const ViewFitting& fitting, const Slice& slice, const glm::dvec3& origin,
                  const ViewAxes& axes) {
  Bounds boxes;
  visit_seen(fitting, slice, [&](const glm::dvec3& point) {
    const glm::dvec3 offset = point - origin;
    boxes.add({glm::dot(offset, axes.right()), -glm::dot(offset, axes.up),
               glm::dot(offset, axes.forward)});
  });
  return boxes;
}

/// What of a slice is seen: no more than samples tell, and no more than boxes do, but for filters
/// that also average what a pixel reaches beyond. Without any samples, all of the slice.
std::vector<glm::dvec3> corners_seen(const ViewFitting& fitting, const Slice& slice,
                                     const Bounds& samples, const glm::dvec3& origin,
                                     const ViewAxes& axes) {
  if (samples.empty()) {
    const auto ends = corners_of(fitting.camera, slice);
    return {ends.begin(), ends.end()};
  }
  Bounds seen = samples;
  if (const Bounds boxes = seen_boxes(fitting, slice, origin, axes);
      !boxes.empty() && !fitting.use.common_range) {
    const Bounds both{glm::max(seen.low, boxes.low), glm::min(seen.high, boxes.high)};
    if (both.low.x <= both.high.x && both.low.y <= both.high.y) seen = both;
  }
  std::vector<glm::dvec3> corners;
  for (const double x : {seen.low.x, seen.high.x})
    for (const double y : {seen.low.y, seen.high.y})
      corners.push_back(origin + x * axes.right() - y * axes.up);
  return corners;
}

/// Ends the views' ranges behind the farthest sample: no map is asked beyond.
void end_at_samples(std::vector<shader::MapView>& views, const std::vector<Bounds>& seen,
                    const glm::dvec3& origin) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (seen[i].empty()) continue;
    const glm::dvec3 from = origin - glm::dvec3(views[i].origin);
    const auto far =
        static_cast<float>(glm::dot(from, glm::dvec3(views[i].forward)) + seen[i].high.z);
    if (far > views[i].range.x && far < views[i].range.y)
      set_range(views[i], views[i].range.x, far);
  }
}

std::vector<shader::MapView> fit_to_samples(const ViewFitting& fitting) {
  const ViewAxes axes = axes_with_down(fitting.light, fitting.camera.direction);
  const auto slices = cut_slices(sampled_slice(fitting), fitting.parameters);
  const glm::dvec3 origin = fitting.camera.position;
  std::vector<shader::MapView> asked;
  for (std::size_t i = 0; i + 1 < slices.size(); ++i)
    asked.push_back(asked_view(origin, axes, slices[i]));
  const std::vector<Bounds> seen = fitting.seen_bounds(asked, true);

  const double covered = bounds_along(covered_box(fitting.scene, fitting.fit), axes).size().z;
  std::vector<shader::MapView> views;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    FocusedView focused =
        focused_view(fitting, axes, corners_seen(fitting, slices[i], seen[i], origin, axes));
    bend_and_fill(focused.view, focused.seen, {0.0, std::numeric_limits<double>::infinity()},
                  extent_radius(*fitting.light.source) * covered / focused.half, fitting);
    set_choice(focused.view, slices, i);
    views.push_back(focused.view);
  }
  fit_ranges(views, fitting.scene, fitting.fit, fitting.use.common_range);
  // Filters that average depths also average what lies beyond: clamped there, it would darken.
  if (!fitting.use.common_range) end_at_samples(views, seen, origin);
  return views;
}

}  // namespace

Layout describe_cascaded_sdsm();
Layout describe_cascaded_sdsm() {
  return {.id = "cascaded-sdsm",
          .meaning =
              "slices as of cascaded, each fitted to samples of what the camera really sees, for "
              "directional lights",
          .parameters = split_parameters(),
          .serves = {LightKind::directional},
          .view_count = [](const TechniqueInput& input) { return cascade_count(input.parameters); },
          .fit = fit_to_samples,
          .warps = always_warps,
          .reads_samples = true};
}

}  // namespace penumbra::shadow_maps
