#include "renderer/shadow_maps/views/light_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/error.h"
#include "renderer/scene/convex_clip.h"
#include "renderer/scene/transforms.h"
#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::shadow_maps {
namespace {

/// Clip matrix with w as the distance along forward; z is unused, since depth is written by shader.
glm::mat4 clip_matrix(const glm::dvec3& origin, const glm::dvec3& right, const glm::dvec3& down,
                      const glm::dvec3& forward, bool perspective) {
  // right and down are scaled: a = dot(v, right) / |right|^2.
  const glm::dvec3 x = right / glm::dot(right, right);
  const glm::dvec3 y = down / glm::dot(down, down);
  glm::dmat4 clip(0.0);
  const auto row = [&](int r, const glm::dvec3& axis) {
    for (int c = 0; c < 3; ++c) clip[c][r] = axis[c];
    clip[3][r] = -glm::dot(axis, origin);
  };
  row(0, x);
  row(1, y);
  if (perspective)
    row(3, forward);
  else
    clip[3][3] = 1.0;
  return glm::mat4(clip);
}

/// Distances along a view's axis, m.
struct DepthRange {
  double near = std::numeric_limits<double>::infinity();
  double far = -std::numeric_limits<double>::infinity();
};

/// Widens the range by the part of a box between the view's side planes. A box that reaches past
/// them would otherwise begin behind the light.
void extend_range(const shader::MapView& view, const Bounds& box, const GpuScene& scene,
                  DepthRange& range) {
  const Bounds world = scene.near_part(box);
  if (world.empty()) return;
  const auto sides = side_planes(glm::dmat4(view.clip_from_world));
  const glm::dvec3 origin(view.origin);
  if (contains(world, origin)) range.near = std::min(range.near, 0.0);
  visit_clipped_corners(world, sides, [&](const glm::dvec3& point) {
    const double distance = glm::dot(point - origin, glm::dvec3(view.forward));
    range.near = std::min(range.near, distance);
    range.far = std::max(range.far, distance);
  });
}

/// Begins at the first box of either kind and ends at the last receiver: what lies behind it
/// shadows nothing.
DepthRange range_of(const shader::MapView& view, const GpuScene& scene, const LightFit& fit) {
  DepthRange casters, receivers;
  for (const Bounds& box : fit.casters) extend_range(view, box, scene, casters);
  for (const Bounds& box : fit.receivers) extend_range(view, box, scene, receivers);
  return {std::min(casters.near, receivers.near), receivers.far};
}

void set_widened_range(shader::MapView& view, DepthRange range) {
  const bool perspective = view.origin.w > 0.5f;
  if (!(range.far > 0.0)) range.far = 1.0;  // nothing before the light
  // A light inside the scene's boxes starts close to itself; linear depth loses nothing by that.
  const double near = std::clamp(range.near, perspective ? 1e-4 * range.far : 0.0, range.far);
  const double margin = 1e-4 * std::max(range.far - near, 1e-3 * range.far);
  set_range(view, static_cast<float>(std::max(near - margin, 0.0)),
            static_cast<float>(range.far + margin));
}

}  // namespace

void set_fitted_range(shader::MapView& view, double near, double far) {
  set_widened_range(view, DepthRange{near, far});
}

shader::MapView make_view(const glm::dvec3& origin, const ViewAxes& axes, double half_width,
                          bool perspective, double size) {
  const glm::dvec3 right = axes.right() * half_width;
  const glm::dvec3 down = -axes.up * half_width;
  shader::MapView view{};
  view.clip_from_world = clip_matrix(origin, right, down, axes.forward, perspective);
  view.origin = glm::vec4(origin, perspective ? 1.0 : 0.0);
  view.right = glm::vec4(right, 0.0);
  view.up = glm::vec4(down, 0.0);
  view.forward = glm::vec4(axes.forward, 2.0 * half_width / size);
  view.texels = {static_cast<float>(size), 0.0f, 0.0f, 0.0f};
  for (int column = 0; column < 3; ++column) view.unwarp[column][column] = 1.0f;
  return view;
}

namespace {
/// Half angle of the widest cone that is served by one view, degrees.
constexpr double widest_single_view = 75.0;
constexpr double tangent_of_six_views = 1.0;  ///< of the half angle of each
}  // namespace

bool has_six_views(const Light& light) {
  return beam_half_angle(light) > widest_single_view;
}

std::optional<AimedView> view_of_box(const Bounds& box, const glm::dvec3& place) {
  if (box.empty()) return std::nullopt;
  const glm::dvec3 towards = box.center() - place;
  // Every corner lies ahead.
  if (!(glm::length(towards) > box.radius())) return std::nullopt;
  const glm::dvec3 forward = glm::normalize(towards);
  AimedView best{{forward, {}}, std::numeric_limits<double>::infinity()};
  // Turned along each of the box's edges: a square holds a box that lies askew in it worse.
  for (int edge = 0; edge < 3; ++edge) {
    glm::dvec3 along(0.0);
    along[edge] = 1.0;
    const ViewAxes axes{forward, across(forward, along)};
    double tangent = 0.0;
    visit_clipped_corners(box, {}, [&](const glm::dvec3& corner) {
      const glm::dvec3 offset = corner - place;
      const double ahead = glm::dot(offset, forward);
      tangent = std::max({tangent, std::abs(glm::dot(offset, axes.right())) / ahead,
                          std::abs(glm::dot(offset, axes.up)) / ahead});
    });
    if (tangent < best.tangent) best = {axes, tangent};
  }
  // A face's texels are as wide as in its middle times the cosine to its axis.
  const glm::dvec3 cosines = glm::abs(forward);
  const double widest = tangent_of_six_views * std::max({cosines.x, cosines.y, cosines.z});
  if (best.tangent > widest) return std::nullopt;
  return best;
}

std::vector<shader::MapView> views_around(const WorldLight& light, double widen, double size) {
  std::vector<ViewAxes> axes{{light.direction, light.up}};
  double tangent = std::tan(glm::radians(light.source->outer_angle));
  if (has_six_views(*light.source)) {
    axes = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 0, 1}},
            {{0, -1, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 1, 0}},  {{0, 0, -1}, {0, 1, 0}}};
    tangent = tangent_of_six_views;
  }
  std::vector<shader::MapView> views;
  for (const ViewAxes& view_axes : axes)
    views.push_back(make_view(light.position, view_axes, tangent * widen, true, size));
  return views;
}

ViewAxes axes_with_down(const WorldLight& light, const glm::dvec3& down) {
  return {light.direction, across(light.direction, -down)};
}

void cut_casters(shader::MapView& view, const glm::dvec4& kept) {
  // Depth is written by the shader, so that z serves to clip alone: 0 <= z. As small as it is here
  // it never passes w.
  const glm::dvec4 z = 1e-12 * kept / glm::length(glm::dvec3(kept));
  for (int column = 0; column < 4; ++column)
    view.clip_from_world[column].z = static_cast<float>(z[column]);
}

bool cuts_casters(const shader::MapView& view) {
  for (int column = 0; column < 4; ++column)
    if (view.clip_from_world[column].z != 0.0f) return true;
  return false;
}

void warp_view(shader::MapView& view, const glm::dmat3& warp, double size) {
  const glm::dmat4 clip(view.clip_from_world);
  for (int column = 0; column < 4; ++column) {
    const glm::dvec3 bent = warp * glm::dvec3(clip[column].x, clip[column].y, clip[column].w);
    view.clip_from_world[column] = glm::vec4(bent.x, bent.y, clip[column].z, bent.z);
  }
  const glm::dmat3 texels_from_clip(0.5 * size, 0.0, 0.0, 0.0, 0.5 * size, 0.0, 0.5 * size,
                                    0.5 * size, 1.0);
  const glm::dmat3 unwarp = texels_from_clip * glm::inverse(warp) * glm::inverse(texels_from_clip);
  for (int column = 0; column < 3; ++column) view.unwarp[column] = glm::vec4(unwarp[column], 0.0);
}

bool is_warped(const shader::MapView& view) {
  const glm::mat3 unwarp{view.unwarp[0], view.unwarp[1], view.unwarp[2]};
  return unwarp != glm::mat3(1.0f);
}

double guard_share(const MapUse& use, std::uint32_t size) {
  // Up to a quarter of the view.
  return std::min((use.border + 1.0) / size, 0.5 - 0.5 / widest_filtered_cone);
}

Bounds covered_box(const GpuScene& scene, const LightFit& fit) {
  const Bounds whole{scene.low(), scene.high()};
  if (!scene.is_far()) return whole;
  Bounds seen;
  for (const Bounds& box : fit.receivers)
    if (const Bounds part = scene.near_part(box); !part.empty()) seen.add(part);
  return seen.empty() ? whole : seen;
}

Bounds bounds_along(const Bounds& box, const ViewAxes& axes) {
  const glm::dvec3 right = axes.right();
  Bounds bounds;
  const glm::dvec3 low = box.low;
  const glm::dvec3 high = box.high;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                           (corner & 4) != 0 ? high.z : low.z);
    bounds.add({glm::dot(point, right), glm::dot(point, axes.up), glm::dot(point, axes.forward)});
  }
  return bounds;
}

void set_range(shader::MapView& view, float near, float far) {
  view.range = {near, far, 1.0f / (far - near), view.range.w};
}

namespace {
bool is_hyperbolic(const ParameterValues& parameters) {
  return parameters.contains("depth") && choice_of(parameters, "depth") == "hyperbolic";
}
}  // namespace

void set_given_range(shader::MapView& view, const ParameterValues& parameters) {
  if (!parameters.contains("near")) return;
  const auto given = [&](const char* name) {
    const auto value = static_cast<float>(real_of(parameters, name));
    if (real_of(parameters, name) > 0.0 && value < std::numeric_limits<float>::min())
      throw bad_value(name, std::string(name) + " is smaller than a float can be");
    return value;
  };
  const float given_near = given("near");
  const float given_far = given("far");
  float near = view.range.x;
  float far = view.range.y;
  // 1/z begins somewhere before 0, where that was not asked for.
  if (is_hyperbolic(parameters)) near = std::max(near, 1e-4f * far);
  if (given_near > 0.0f) near = given_near;
  if (given_far > 0.0f) far = given_far;
  if (near >= far)
    throw bad_value(given_near > 0.0f ? "near" : "far",
                    "the map's range must end behind where it begins, but near is " +
                        to_text(double{near}) + " m and far " + to_text(double{far}) +
                        " m (0 fits them to the scene)");
  set_range(view, near, far);
}

void count_from_scene(shader::MapView& view, const GpuScene& scene,
                      const ParameterValues& parameters) {
  // 1/z is counted from the light, and tiles find their ranges themselves.
  if (is_hyperbolic(parameters) || !keeps_image(parameters)) return;
  const double near{view.range.x}, far{view.range.y};
  const double size = glm::length(glm::max(glm::abs(scene.low()), glm::abs(scene.high())));
  // Nearer lights lose little, and keep every bit.
  constexpr double far_away = 16.0;
  if (view.origin.w < 0.5f || near < far_away * (far - near + size)) return;
  const double moved = near - size;
  // As shaders have it, which is not quite unit.
  const glm::dvec3 forward(view.forward);
  view.origin = glm::vec4(glm::dvec3(view.origin) + moved * forward, 1.0);
  view.right.w = static_cast<float>(moved);
  const double passed = moved * glm::dot(forward, forward);
  set_range(view, static_cast<float>(near - passed), static_cast<float>(far - passed));
}

namespace {

/// Longest step on the unwarped map for a step of one texel, over the map's corners, from above.
double widest_texel(const shader::MapView& view, double size) {
  const glm::dmat3 unwarp{glm::dvec3(view.unwarp[0]), glm::dvec3(view.unwarp[1]),
                          glm::dvec3(view.unwarp[2])};
  double widest = 0.0;
  for (const double x : {0.0, size})
    for (const double y : {0.0, size}) {
      const glm::dvec3 place = unwarp * glm::dvec3(x, y, 1.0);
      double squares = 0.0;
      for (int column = 0; column < 2; ++column) {
        const glm::dvec2 step =
            (glm::dvec2(unwarp[column]) - glm::dvec2(place) / place.z * unwarp[column].z) / place.z;
        squares += glm::dot(step, step);
      }
      widest = std::max(widest, std::sqrt(squares));
    }
  return widest;
}

/// One range that holds all.
DepthRange hull(const std::vector<DepthRange>& ranges) {
  DepthRange all;
  for (const DepthRange& range : ranges) {
    all.near = std::min(all.near, range.near);
    all.far = std::max(all.far, range.far);
  }
  return all;
}

}  // namespace

void fix_ranges(std::vector<shader::MapView>& views, const GpuScene& scene, const LightFit& fit) {
  DepthRange all{0.0, 0.0};
  for (const shader::MapView& view : views) {
    const auto add = [&](const glm::dvec3& point) {
      all.far =
          std::max(all.far, glm::dot(point - glm::dvec3(view.origin), glm::dvec3(view.forward)));
    };
    visit_clipped_corners(covered_box(scene, fit), {}, add);
  }
  for (shader::MapView& view : views) set_widened_range(view, all);
}

void fit_ranges_to(std::vector<shader::MapView>& views, const std::vector<Bounds>& seen,
                   const MapUse& use, double slope_scale, double bias, double size) {
  std::vector<DepthRange> ranges;
  for (std::size_t i = 0; i < views.size(); ++i) {
    ranges.emplace_back();
    if (seen[i].empty()) continue;
    // What a comparison grants must not reach before near, where casters are that were clamped.
    const double distance = views[i].origin.w > 0.5f ? seen[i].low.z : 1.0;
    const double texel = static_cast<double>(views[i].forward.w) * distance *
                         std::max(widest_texel(views[i], size), 1.0);
    const double granted = 3.0 * (1.0 + use.kernel_radius) * slope_scale * texel + bias;
    ranges[i] = {seen[i].low.z - granted, seen[i].high.z};
  }
  if (use.common_range) ranges.assign(ranges.size(), hull(ranges));
  for (std::size_t i = 0; i < views.size(); ++i)
    if (ranges[i].far > ranges[i].near) set_widened_range(views[i], ranges[i]);
}

void fit_ranges(std::vector<shader::MapView>& views, const GpuScene& scene, const LightFit& fit,
                bool common) {
  std::vector<DepthRange> ranges;
  for (const shader::MapView& view : views) ranges.push_back(range_of(view, scene, fit));
  if (common) ranges.assign(ranges.size(), hull(ranges));
  for (std::size_t i = 0; i < views.size(); ++i) set_widened_range(views[i], ranges[i]);
}

}  // namespace penumbra::shadow_maps
