#include "renderer/shadow_maps/views/place_tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/error.h"
#include "renderer/scene/convex_clip.h"
#include "renderer/shadow_maps/texels/tiles.h"
#include "renderer/shadow_maps/views/light_view.h"
#include "renderer/shadow_maps/views/seen.h"

namespace penumbra::shadow_maps {
namespace {

/// A square of the plane across the light's direction, in its fixed axes: they must not turn with
/// the camera.
struct TileSquare {
  glm::dvec2 center;
  double radius;  ///< half of its width, m
};

/// The camera stands on the circle inside the square and looks towards its centre (Alecu 2014,
/// 3.2). A square of no given radius is as wide as the scene is long, and moved by as much as it
/// takes to hold what is seen: of cameras outside of the scene, or that look almost along the
/// light.
TileSquare place_square(const ViewFitting& fitting, const ViewAxes& axes, const Bounds& covered) {
  const auto on_plane = [&](const glm::dvec3& v) {
    return glm::dvec2(glm::dot(v, axes.right()), glm::dot(v, axes.up));
  };
  const double given = real_of(fitting.parameters, "tile_radius");
  const double length_of_scene = glm::length(covered.size());
  if (given > 0.0 && given < 1e-6 * length_of_scene)
    throw bad_value("tile_radius", "tile_radius is less than a millionth of the scene's length, " +
                                       to_text(length_of_scene) + " m");
  TileSquare square{on_plane(fitting.camera.position),
                    given > 0.0 ? given : std::max(0.5 * length_of_scene, 1e-6)};
  const glm::dvec2 ahead = on_plane(fitting.camera.direction);
  // Nearer than this the camera looks along the light: then it stands in the middle.
  if (const double length = glm::length(ahead); length > 1e-3)
    square.center += square.radius / length * ahead;
  if (given > 0.0) return square;
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  visit_seen(fitting, visible_slice(fitting), [&](const glm::dvec3& point) {
    low = glm::min(low, on_plane(point));
    high = glm::max(high, on_plane(point));
  });
  for (int axis = 0; axis < 2; ++axis)
    if (low[axis] + square.radius >= high[axis] - square.radius)
      square.center[axis] =
          std::clamp(square.center[axis], high[axis] - square.radius, low[axis] + square.radius);
  return square;
}

/// From the nearest to the farthest place of the bounding spheres of casters that a tile's four
/// sides leave.
void fit_to_spheres(shader::MapView& view, const GpuScene& scene) {
  const auto sides = side_planes(glm::dmat4(view.clip_from_world));
  double near = std::numeric_limits<double>::infinity();
  double far = -near;
  for (const DrawRange& range : scene.ranges()) {
    const Bounds box = range.box();
    const double radius = 0.5 * glm::length(box.size());
    if (!range.casts_shadow || !may_touch(box.center(), radius, sides)) continue;
    const double middle =
        glm::dot(box.center() - glm::dvec3(view.origin), glm::dvec3(view.forward));
    near = std::min(near, middle - radius);
    far = std::max(far, middle + radius);
  }
  if (near < far) set_fitted_range(view, near, far);
}

}  // namespace

std::vector<Parameter> tile_parameters() {
  return {
      real("importance_range", 0.0, {0.0, 1e6},
           "Depth before the camera up to which a pixel adds more than 1 to its tile's importance. "
           "0: half of the tiles' common width.")
          .in("m"),
      real("importance_gain", 8.0, {0.0, 1024.0},
           "What a pixel at the camera adds to its tile's importance beyond 1."),
      real("tile_radius", 0.0, {0.0, 1e6},
           "Half of the width of all tiles together. 0: half of the scene's length, and the tiles "
           "are moved where that does not hold what is seen; otherwise what lies beyond them is "
           "lit.")
          .in("m"),
      choice("tile_range", "visible", {"visible", "casters", "common"},
             "Where the range of each tile's depths lies, where range is boxes. visible: from the "
             "nearest to the farthest place seen in it. casters: around the bounding spheres of "
             "casters. common: one range for all, which penumbrae always have."),
      choice("tile_sizes", "set", {"set", "proportional"},
             "Texels of the tiles. set: 1024, 512, 256 and so on by rank of importance. "
             "proportional: as many as each one's share of all importance, at most 1024 a side."),
      choice("tile_culling", "spheres", {"spheres", "boxes"},
             "Bounds by which casters are left out of a tile. A sphere is drawn around the box.")};
}

bool ranges_follow_samples(const ParameterValues& parameters, const MapUse& use) {
  if (use.follows_extent || use.common_range) return false;
  const auto given = [&](const char* name) {
    return parameters.contains(name) && real_of(parameters, name) > 0.0;
  };
  if (given("near") || given("far")) return false;
  const std::string& range = choice_of(parameters, "range");
  return range == "visible" ||
         (range == "boxes" && choice_of(parameters, "tile_range") == "visible");
}

std::vector<shader::MapView> place_tiles(const ViewFitting& fitting) {
  const ViewAxes axes{fitting.light.direction, fitting.light.up};
  const Bounds covered = bounds_along(covered_box(fitting.scene, fitting.fit), axes);
  const TileSquare square = place_square(fitting, axes, covered);
  const double half = square.radius / shader::tiles_a_side;
  std::vector<shader::MapView> placed;
  for (int row = 0; row < shader::tiles_a_side; ++row)
    for (int column = 0; column < shader::tiles_a_side; ++column) {
      const double right = square.center.x + half * (2 * column + 1 - shader::tiles_a_side);
      const double up = square.center.y - half * (2 * row + 1 - shader::tiles_a_side);
      placed.push_back(make_view(right * axes.right() + up * axes.up + covered.low.z * axes.forward,
                                 axes, half, false, shader::largest_tile));
    }
  fit_ranges(placed, fitting.scene, fitting.fit, true);
  if (choice_of(fitting.parameters, "tile_range") != "common" && !fitting.use.follows_extent &&
      !fitting.use.common_range)
    for (shader::MapView& tile : placed) fit_to_spheres(tile, fitting.scene);
  return placed;
}

Layout tile_layout(const std::string& id, const std::string& meaning, TileRanking ranking) {
  return {.id = id,
          .meaning = meaning,
          .parameters = tile_parameters(),
          .serves = {LightKind::directional},
          .view_count = [](const TechniqueInput&) { return std::uint32_t{shader::tile_count}; },
          .fit = place_tiles,
          .reads_samples = true,
          .ranking = ranking};
}

}  // namespace penumbra::shadow_maps
