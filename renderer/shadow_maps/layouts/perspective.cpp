#include <algorithm>
#include <cmath>

#include "renderer/scene/convex_clip.h"
#include "renderer/shadow_maps/views/warp.h"

namespace penumbra::shadow_maps {
namespace {

/// Least ratio of the nearest to the farthest weight: across the bend, what is near gets at most a
/// hundred times finer texels. Beyond that hardly any would be left for the rest.
constexpr double least_weight = 0.01;

/// A linear function of homogeneous points that is zero at the light: what a picture taken from
/// there divides by.
struct Weight {
  glm::dvec4 row{0.0};
  double even = 0.0;  ///< added everywhere; alone it spreads texels as a plain view does

  double at(const glm::dvec3& point) const { return glm::dot(row, glm::dvec4(point, 1.0)); }
};

/// The camera whose picture's space is mapped: the real one, or moved back along its direction.
struct VirtualCamera {
  CameraMatrices matrices;
  Slice slice;  ///< before it
};

VirtualCamera moved_back(const CameraMatrices& camera, const Slice& seen, double back) {
  VirtualCamera moved{camera, {seen.near, seen.far + back}};
  glm::dmat4 shift(1.0);
  shift[3] = glm::dvec4(back * camera.direction, 1.0);
  moved.matrices.clip_from_world = camera.clip_from_world * shift;
  shift[3] = glm::dvec4(-back * camera.direction, 1.0);
  moved.matrices.world_from_clip = shift * camera.world_from_clip;
  moved.matrices.position = camera.position - back * camera.direction;
  return moved;
}

/// Clip matrix that maps the slice of a camera to the cube from -1 to 1.
glm::dmat4 cube_from_world(const VirtualCamera& camera) {
  glm::dmat4 cube = camera.matrices.clip_from_world;
  const double near = camera.slice.near;
  const double far = std::max(camera.slice.far, near * (1.0 + 1e-6));
  for (int column = 0; column < 4; ++column) {
    const double w = cube[column].w;
    cube[column].z = ((far + near) * w - (column == 3 ? 2.0 * far * near : 0.0)) / (far - near);
  }
  return cube;
}

/// What the light's picture of the camera's cube divides by (Stamminger and Drettakis 2002, 4): it
/// is taken from the light's place in the space after the camera's projection, towards the middle
/// of `points` there.
Weight weight_of(const WorldLight& light, const VirtualCamera& camera,
                 const std::vector<glm::dvec3>& points) {
  const glm::dmat4 cube = cube_from_world(camera);
  const glm::dvec4 place = cube * light.center;
  const glm::dmat4 columns = glm::transpose(cube);
  // In the plane of the camera's eye it becomes a light of parallel rays.
  if (std::abs(place.w) <= 1e-9 * glm::length(glm::dvec3(place))) return {columns[3], 0.0};
  const glm::dvec3 eye = glm::dvec3(place) / place.w;
  Bounds box;
  for (const glm::dvec3& point : points) {
    const glm::dvec4 in_cube = cube * glm::dvec4(point, 1.0);
    if (in_cube.w > 0.0) box.add(glm::dvec3(in_cube) / in_cube.w);
  }
  if (box.empty()) return {};
  const glm::dvec3 towards = box.center() - eye;
  const glm::dvec3 forward = towards / std::max(glm::dot(towards, towards), 1e-18);
  return {columns * glm::dvec4(forward, -glm::dot(forward, eye)), 0.0};
}

/// The eye's place across from which the picture of what is seen is narrowest.
double narrowest_across(const SeenPlaces& seen, double before) {
  const auto width = [&](double across) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const glm::dvec2& point : seen.points) {
      const double slope = (point.x - across) / (before + point.y - seen.low.y);
      low = std::min(low, slope);
      high = std::max(high, slope);
    }
    return high - low;
  };
  // The width is convex: a third of the way from the worse end holds no minimum.
  double low = seen.low.x, high = seen.high.x;
  for (int step = 0; step < 50; ++step) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    if (width(a) < width(b))
      high = b;
    else
      low = a;
  }
  return 0.5 * (low + high);
}

/// A plain view from the light, and what it is to show.
struct Plain {
  shader::MapView view;
  SeenPlaces seen;
  glm::dvec3 right, down;  ///< from its middle to its sides, at unit distance where rays diverge
  glm::dvec3 middle;       ///< a point that it shows there
};

Plain plain_view(const ViewFitting& fitting, const ViewAxes& axes,
                 const std::vector<glm::dvec3>& points) {
  const WorldLight& light = fitting.light;
  if (is_at_infinity(*light.source)) {
    const FocusedView focused = focused_view(fitting, axes, points);
    const glm::dvec3 origin = focused.center.x * axes.right() - focused.center.y * axes.up;
    return {focused.view, focused.seen, focused.half * axes.right(), -focused.half * axes.up,
            origin};
  }
  const double tangent = std::tan(glm::radians(light.source->outer_angle));
  Plain plain{make_view(light.position, axes, tangent, true, fitting.size),
              {},
              tangent * axes.right(),
              -tangent * axes.up,
              light.position + axes.forward};
  double farthest = 0.0;
  for (const glm::dvec3& point : points)
    farthest = std::max(farthest, glm::dot(point - light.position, axes.forward));
  for (const glm::dvec3& point : points) {
    const glm::dvec3 offset = point - light.position;
    const double depth = glm::dot(offset, axes.forward);
    if (depth <= 1e-6 * farthest) continue;  // at the light itself: on the map it is everywhere
    plain.seen.add(glm::dvec2(glm::dot(offset, axes.right()), -glm::dot(offset, axes.up)) /
                   (tangent * depth));
  }
  if (plain.seen.points.empty())
    for (const double side : {-1.0, 1.0}) plain.seen.add({side, side});
  plain.seen.low -= 1e-6;
  plain.seen.high += 1e-6;
  return plain;
}

/// Change of a weight over a plain view, in its units.
glm::dvec2 slope_of(const Weight& weight, const Plain& plain) {
  return {glm::dot(weight.row, glm::dvec4(plain.right, 0.0)),
          glm::dot(weight.row, glm::dvec4(plain.down, 0.0))};
}

double weight_at(const Weight& weight, const Plain& plain, const glm::dvec2& place) {
  return weight.at(plain.middle) + glm::dot(slope_of(weight, plain), place) + weight.even;
}

/// Adds as much of an even weight as leaves all that is seen before the picture's eye.
void keep_before_eye(Weight& weight, const Plain& plain) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const glm::dvec2& place : plain.seen.points) {
    least = std::min(least, weight_at(weight, plain, place));
    most = std::max(most, weight_at(weight, plain, place));
  }
  if (most > 0.0)
    weight.even = std::max(0.0, (least_weight * most - least) / (1.0 - least_weight));
  else
    weight = {glm::dvec4(0.0), 1.0};
}

/// Depth before the camera of the nearest caster that a plain view may show.
double nearest_caster(const ViewFitting& fitting, const Plain& plain) {
  shader::MapView view = plain.view;
  bend_and_fill(view, plain.seen, {0.0, std::numeric_limits<double>::infinity()}, 0.0, fitting);
  const auto sides = side_planes(glm::dmat4(view.clip_from_world));
  double nearest = std::numeric_limits<double>::infinity();
  const auto add = [&](const glm::dvec3& point) {
    nearest = std::min(nearest, depth_of(fitting.camera, point));
  };
  for (const Bounds& caster : fitting.fit.casters) {
    const Bounds box = fitting.scene.near_part(caster);
    if (box.empty()) continue;
    visit_clipped_corners(box, sides, add);
    if (plain.view.origin.w > 0.5f && contains(box, fitting.light.position))
      add(fitting.light.position);
  }
  return nearest;
}

/// Room for penumbrae beside what is seen, in a plain view's units.
double reach_of(const ViewFitting& fitting, const Plain& plain) {
  const double radius = extent_radius(*fitting.light.source) / glm::length(plain.right);
  std::vector<shader::MapView> views{plain.view};
  fit_ranges(views, fitting.scene, fitting.fit, true);
  const double near = static_cast<double>(views[0].range.x);
  const double far = static_cast<double>(views[0].range.y);
  const bool perspective = plain.view.origin.w > 0.5f;
  return perspective ? radius * (1.0 / near - 1.0 / far) : radius * (far - near);
}

/// One view around the camera's picture of what is seen.
shader::MapView fit_view(const ViewFitting& fitting) {
  const WorldLight& light = fitting.light;
  const CameraMatrices& camera = fitting.camera;
  const Slice slice = visible_slice(fitting);
  const std::vector<glm::dvec3> seen = seen_points(fitting, slice);
  std::vector<glm::dvec3> points = seen;
  Plain plain = plain_view(fitting, axes_with_down(light, camera.direction), points);

  // Take that picture from so far behind the camera that it holds every caster.
  const bool moves = boolean_of(fitting.parameters, "virtual_camera");
  const double back = moves ? std::max(0.0, slice.near - nearest_caster(fitting, plain)) : 0.0;
  const VirtualCamera from = moved_back(camera, slice, back);
  if (!boolean_of(fitting.parameters, "cube_clipping")) {
    points = reached_corners(from.matrices, from.slice, light);
    plain = plain_view(fitting, axes_with_down(light, camera.direction), points);
  }
  Weight weight;
  if (has_eye(camera)) weight = weight_of(light, from, points);
  keep_before_eye(weight, plain);

  // Turn the map so that its eye lies above it.
  Bend bend{0.0, std::numeric_limits<double>::infinity()};
  const glm::dvec2 slope = slope_of(weight, plain);
  if (glm::length(slope) > 1e-6 * weight_at(weight, plain, {0.0, 0.0})) {
    plain = plain_view(fitting, axes_with_down(light, slope.x * plain.right + slope.y * plain.down),
                       points);
    bend.before = weight_at(weight, plain, {0.0, plain.seen.low.y}) / slope_of(weight, plain).y;
    bend.across = narrowest_across(plain.seen, bend.before);
  }
  bend_and_fill(plain.view, plain.seen, bend, reach_of(fitting, plain), fitting);
  note_used_texels(fitting, plain.view, seen);
  if (!moves)
    cut_casters(plain.view,
                {camera.direction, -glm::dot(camera.direction, near_corners(camera)[0])});
  return plain.view;
}

std::vector<shader::MapView> fit_perspective(const ViewFitting& fitting) {
  const double widen = 1.0 / (1.0 - 2.0 * guard_share(fitting.use, fitting.size));
  std::vector<shader::MapView> views;
  if (has_six_views(*fitting.light.source))
    views = views_around(fitting.light, widen, fitting.size);
  else
    views.push_back(fit_view(fitting));
  fit_ranges(views, fitting.scene, fitting.fit, true);
  return views;
}

}  // namespace

Layout describe_perspective();
Layout describe_perspective() {
  return {.id = "perspective",
          .meaning =
              "one view of the camera's own perspective picture, for directional and spot lights",
          .parameters = {boolean("virtual_camera", true,
                                 "Take the perspective from so far behind the camera that it holds "
                                 "every caster; otherwise casters behind the camera are lost."),
                         boolean("cube_clipping", true,
                                 "Fit the view to what is seen of the scene; otherwise to all that "
                                 "the camera could see.")},
          .serves = {LightKind::directional, LightKind::spot},
          .view_count =
              [](const TechniqueInput& input) { return has_six_views(input.light) ? 6u : 1u; },
          .fit = fit_perspective,
          .warps = always_warps};
}

}  // namespace penumbra::shadow_maps
