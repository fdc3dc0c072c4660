#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "renderer/scene/scene.h"
#include "techniques/registry.h"

/// What is pushed to its extremes: every axis as data.
namespace penumbra::experiments::stability {

/// One step of an axis, ready to be judged and drawn.
struct Trial {
  Scene scene;
  /// Where the axis only moves a scene as a whole, the scene before: it is judged instead, since
  /// the ideal picture is the same and doubles need not hold what floats are to be tried with.
  std::optional<Scene> unmoved;
  std::uint32_t width = 96;  ///< pixels
  std::uint32_t height = 96;
  std::uint32_t points = 1;    ///< of the light, for the judge and for techniques of many
  ParameterValues parameters;  ///< beside the technique's own
};

struct Axis {
  std::string id;
  std::string title;
  std::string unit;            ///< of the values; empty for plain numbers
  std::vector<double> values;  ///< from gentle to absurd
  std::function<Trial(double)> trial;
  bool whole = false;              ///< values are whole numbers
  std::vector<std::string> names;  ///< of the values, where they are kinds and not amounts

  /// A value as people read it.
  std::string text(double value) const;
  bool has_between() const { return names.empty(); }
};

/// Axes of scene, light and view, in the order of reports: the same for every technique.
const std::vector<Axis>& scene_axes();

/// Two axes for every numeric parameter that a technique declares, from its value upwards and
/// downwards to the ends of its range. `id` is "NAME up" or "NAME down".
std::vector<Axis> parameter_axes(const techniques::Resolved& technique);

/// Largest map that is drawn: greater ones cost seconds on a processor and show nothing new.
constexpr double largest_map = 4096.0;

// Parts of scene_axes().
void add_shape_axes(std::vector<Axis>& axes);
void add_light_axes(std::vector<Axis>& axes);
void add_view_axes(std::vector<Axis>& axes);

}  // namespace penumbra::experiments::stability
