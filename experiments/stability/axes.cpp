#include "experiments/stability/axes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiments/stability/subjects.h"

namespace penumbra::experiments::stability {
namespace {

/// Values between a parameter's own and an end of its range: by equal factors where its scale is
/// logarithmic and it spans some, otherwise by growing shares of the way.
std::vector<double> values_towards(const Parameter& parameter, double from, double to) {
  std::vector<double> values{from};
  constexpr int steps = 6;
  const bool factors = parameter.scale == ParameterScale::logarithmic && from > 0.0 && to > 0.0;
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    double value = factors ? from * std::pow(to / from, share)
                           : from + (to - from) * std::pow(10.0, 3.0 * (share - 1.0));
    if (i == steps) value = to;
    if (parameter.type == ParameterType::integer) value = std::round(value);
    if (value != values.back()) values.push_back(value);
  }
  return values;
}

double number_of(const ParameterValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::get<double>(value);
}

ParameterValue value_of(const Parameter& parameter, double value) {
  if (parameter.type == ParameterType::integer) return static_cast<std::int64_t>(value);
  return value;
}

}  // namespace

std::string Axis::text(double value) const {
  if (!names.empty()) return names.at(static_cast<std::size_t>(value));
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return unit.empty() ? text : std::string(text) + " " + unit;
}

const std::vector<Axis>& scene_axes() {
  static const std::vector<Axis> axes = [] {
    std::vector<Axis> list;
    add_shape_axes(list);
    add_light_axes(list);
    add_view_axes(list);
    return list;
  }();
  return axes;
}

std::vector<Axis> parameter_axes(const techniques::Resolved& technique) {
  std::vector<Axis> axes;
  for (const Parameter& parameter : technique.technique->parameters) {
    if (parameter.type != ParameterType::integer && parameter.type != ParameterType::real) continue;
    const double from = number_of(technique.parameters.at(parameter.name));
    const double high =
        parameter.name == "map_size" ? std::min(parameter.maximum, largest_map) : parameter.maximum;
    for (const bool up : {false, true}) {
      const std::vector<double> values =
          values_towards(parameter, from, up ? high : parameter.minimum);
      if (values.size() < 2) continue;
      Axis axis;
      axis.id = parameter.name + (up ? " up" : " down");
      axis.title = parameter.name + (up ? ", upwards" : ", downwards");
      axis.unit = parameter.unit;
      axis.values = values;
      axis.whole = parameter.type == ParameterType::integer;
      axis.trial = [parameter](double value) {
        Trial trial{.scene = askew(subject())};
        trial.parameters[parameter.name] = value_of(parameter, value);
        return trial;
      };
      axes.push_back(std::move(axis));
    }
  }
  return axes;
}

}  // namespace penumbra::experiments::stability
