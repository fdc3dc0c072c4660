#include "renderer/shadow_maps/views/warp.h"

#include <algorithm>
#include <cmath>

namespace penumbra::shadow_maps {
namespace {

/// Sine below which camera and light count as parallel: 3 degrees.
constexpr double parallel = 0.05;

/// Places of the plane across the light, m.
SeenPlaces places_on_plane(const std::vector<glm::dvec3>& points, const ViewAxes& axes) {
  SeenPlaces plane;
  for (const glm::dvec3& point : points)
    plane.add({glm::dot(point, axes.right()), -glm::dot(point, axes.up)});
  // A plane seen edge-on has an extent all the same.
  const double least = 1e-6 + 1e-6 * glm::length(plane.size());
  plane.low -= least;
  plane.high += least;
  return plane;
}

/// From a square around the origin, `half` as wide, to a perspective picture of what lies before
/// (camera, low.y - distance), y from -1 at low.y to 1 at high.y.
glm::dmat3 perspective_warp(double camera, double low, double high, double distance) {
  const double length = high - low;
  const double a = (length + 2.0 * distance) / length;
  const double b = -2.0 * (distance + length) * distance / length;
  const double shift = distance - low;
  glm::dmat3 warp(1.0);  // columns: of x, y, 1
  warp[0] = {1.0, 0.0, 0.0};
  warp[1] = {0.0, a, 1.0};
  warp[2] = {-camera, a * shift + b, shift};
  return warp;
}

/// Moves and scales x and y so that the points' bounds reach `share` of the way to -1 and 1.
glm::dmat3 fill(const glm::dmat3& warp, const std::vector<glm::dvec2>& points, double share) {
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (const glm::dvec2& point : points) {
    const glm::dvec3 place = warp * glm::dvec3(point, 1.0);
    low = glm::min(low, glm::dvec2(place) / place.z);
    high = glm::max(high, glm::dvec2(place) / place.z);
  }
  const glm::dvec2 half = glm::max(0.5 * (high - low), glm::dvec2(1e-9));
  const glm::dvec2 scale = share / half;
  const glm::dvec2 center = 0.5 * (low + high);
  const glm::dmat3 placed(scale.x, 0.0, 0.0, 0.0, scale.y, 0.0, -scale.x * center.x,
                          -scale.y * center.y, 1.0);
  return placed * warp;
}

/// Area of the convex hull (Andrew 1979).
double hull_area(std::vector<glm::dvec2> points) {
  const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
  std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  double twice = 0.0;
  for (int side = 0; side < 2; ++side) {
    std::vector<glm::dvec2> chain;
    for (const glm::dvec2& point : points) {
      while (chain.size() > 1 &&
             cross(chain.back() - chain[chain.size() - 2], point - chain.back()) <= 0.0)
        chain.pop_back();
      chain.push_back(point);
    }
    for (std::size_t i = 1; i < chain.size(); ++i) twice += cross(chain[i - 1], chain[i]);
    std::reverse(points.begin(), points.end());
  }
  return 0.5 * twice;
}

/// Axes whose y, downwards on the map, leads away from the camera.
ViewAxes axes_along(const WorldLight& light, const glm::dvec3& ahead, double sine) {
  if (sine < parallel) return {light.direction, light.up};
  return {light.direction, -ahead / sine};
}

}  // namespace

bool has_eye(const CameraMatrices& camera) {
  const glm::dmat4& clip = camera.clip_from_world;
  return glm::length(glm::dvec3(clip[0].w, clip[1].w, clip[2].w)) > 0.0;
}

FocusedView focused_view(const ViewFitting& fitting, const ViewAxes& axes,
                         const std::vector<glm::dvec3>& points) {
  const SeenPlaces plane = places_on_plane(points, axes);
  const Bounds covered = bounds_along(covered_box(fitting.scene, fitting.fit), axes);
  const glm::dvec2 center = 0.5 * (plane.low + plane.high);
  const glm::dvec2 size = plane.size();
  const double half = 0.5 * std::max(size.x, size.y);
  const glm::dvec3 origin =
      center.x * axes.right() - center.y * axes.up + covered.low.z * axes.forward;
  FocusedView focused{make_view(origin, axes, half, false, fitting.size), {}, half, center};
  for (const glm::dvec2& point : plane.points) focused.seen.add((point - center) / half);
  focused.seen.low = -0.5 * size / half;
  focused.seen.high = 0.5 * size / half;
  return focused;
}

void bend_and_fill(shader::MapView& view, const SeenPlaces& seen, const Bend& bend, double reach,
                   const ViewFitting& fitting) {
  glm::dmat3 warp(1.0);
  if (std::isfinite(bend.before))
    warp = perspective_warp(bend.across, seen.low.y, seen.high.y, std::max(bend.before, 1e-4));
  double share = 1.0 - 2.0 * guard_share(fitting.use, fitting.size);
  if (fitting.use.follows_extent) {
    // Room for the widest penumbra, but for no more than half of the map.
    const double narrow = 0.5 * std::min(seen.size().x, seen.size().y);
    share = std::min(share, std::max(narrow / (narrow + reach), 0.5));
  }
  warp_view(view, fill(warp, seen.points, share), fitting.size);
}

void note_used_texels(const ViewFitting& fitting, const shader::MapView& view,
                      const std::vector<glm::dvec3>& points) {
  std::vector<glm::dvec2> places;
  for (const glm::dvec3& point : points) {
    const glm::dvec4 clip = glm::dmat4(view.clip_from_world) * glm::dvec4(point, 1.0);
    if (clip.w > 0.0) places.push_back(glm::clamp(glm::dvec2(clip) / clip.w, -1.0, 1.0));
  }
  const double share = hull_area(std::move(places)) / 4.0;
  fitting.notes.push_back("light " + fitting.light.source->name + ": what is seen covers " +
                          std::to_string(std::lround(100.0 * share)) + "% of its map");
}

std::vector<glm::dvec3> seen_points(const ViewFitting& fitting, const Slice& slice) {
  std::vector<glm::dvec3> points;
  visit_seen(fitting, slice, [&](const glm::dvec3& point) { points.push_back(point); });
  return points.empty() ? reached_corners(fitting.camera, slice, fitting.light) : points;
}

std::vector<shader::MapView> fit_warped(const ViewFitting& fitting,
                                        const std::function<double(const WarpInput&)>& distance) {
  const WorldLight& light = fitting.light;
  const CameraMatrices& camera = fitting.camera;
  const glm::dvec3 ahead =
      camera.direction - glm::dot(camera.direction, light.direction) * light.direction;
  const double sine = glm::length(ahead);
  const ViewAxes axes = axes_along(light, ahead, sine);
  const Slice seen = visible_slice(fitting);
  const std::vector<glm::dvec3> points = seen_points(fitting, seen);
  FocusedView focused = focused_view(fitting, axes, points);

  Bend bend{(glm::dot(camera.position, axes.right()) - focused.center.x) / focused.half,
            std::numeric_limits<double>::infinity()};
  if (sine >= parallel && has_eye(camera))
    bend.before = distance({seen, focused.seen.size().y * focused.half, sine}) / focused.half;
  const double covered = bounds_along(covered_box(fitting.scene, fitting.fit), axes).size().z;
  bend_and_fill(focused.view, focused.seen, bend,
                extent_radius(*light.source) * covered / focused.half, fitting);
  note_used_texels(fitting, focused.view, points);
  std::vector<shader::MapView> views{focused.view};
  fit_ranges(views, fitting.scene, fitting.fit, true);
  return views;
}

}  // namespace penumbra::shadow_maps
