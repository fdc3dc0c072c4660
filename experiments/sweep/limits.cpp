#include "experiments/sweep/limits.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/report/rows.h"
#include "experiments/sweep/grid.h"

namespace penumbra::experiments {
namespace {

constexpr double many_fragments = 8.0;
constexpr double hardly_grows = 0.25;

double largest_size(const TimeGrid& grid) {
  double largest = 0.0;
  for (const auto& point : grid.points) largest = std::max(largest, point.pixels);
  return largest;
}

/// The upper half of the points by x, at least two.
std::optional<double> upper_exponent(std::vector<std::pair<double, double>> points) {
  std::sort(points.begin(), points.end());
  const std::size_t kept = std::max<std::size_t>(2, (points.size() + 1) / 2);
  if (points.size() > kept)
    points.erase(points.begin(), points.end() - static_cast<std::ptrdiff_t>(kept));
  return exponent(points);
}

}  // namespace

std::optional<double> exponent(const std::vector<std::pair<double, double>>& points) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const auto& [x, y] : points) {
    if (!(x > 0.0) || !(y > 0.0)) return std::nullopt;
    const double u = std::log(x), v = std::log(y);
    n += 1.0;
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 2.0 || spread <= 1e-9) return std::nullopt;
  return (n * sxy - sx * sy) / spread;
}

TimeGrid time_grid(const std::vector<nlohmann::json>& rows, const std::string& name, int triangles,
                   int lights) {
  TimeGrid grid;
  for (const auto& row : rows) {
    if (!is_done(row) || row.at("name") != name) continue;
    const auto scene = read_sweep_scene(row.at("scene").get<std::string>());
    if (!scene || scene->triangles != triangles || scene->lights != lights) continue;
    grid.points.push_back({scene->objects, number_of(row, "width"), number_of(row, "frame_ms"),
                           number_of(row, "fragments")});
  }
  return grid;
}

std::optional<Limits> limits_of(const TimeGrid& grid) {
  if (grid.points.empty()) return std::nullopt;
  Limits limits;
  limits.largest = largest_size(grid);
  std::map<int, double> at_largest;
  for (const auto& point : grid.points) {
    if (point.pixels == limits.largest) at_largest[point.objects] = point.ms;
    if (point.ms >= real_time_ms || point.objects < limits.objects) continue;
    limits.size =
        point.objects > limits.objects ? point.pixels : std::max(limits.size, point.pixels);
    limits.objects = point.objects;
  }
  double passed = 0.0, passed_ms = 0.0;
  for (const auto& [objects, ms] : at_largest) {
    if (ms >= real_time_ms) {
      limits.at_largest = passed == 0.0 ? 0.0
                                        : passed + (objects - passed) * (real_time_ms - passed_ms) /
                                                       (ms - passed_ms);
      return limits;
    }
    passed = objects;
    passed_ms = ms;
  }
  limits.at_largest = passed;
  limits.beyond = true;
  return limits;
}

std::optional<Growth> growth_of(const TimeGrid& grid) {
  if (grid.points.empty()) return std::nullopt;
  int most = 0;
  const double largest = largest_size(grid);
  for (const auto& point : grid.points)
    if (point.pixels == largest) most = std::max(most, point.objects);
  std::vector<std::pair<double, double>> pixels, objects;
  std::map<double, double> fragments;  // by area
  Growth growth;
  for (const auto& point : grid.points) {
    if (point.objects == most) pixels.emplace_back(point.pixels * point.pixels, point.ms);
    if (point.pixels == largest) objects.emplace_back(point.objects, point.ms);
    if (point.objects == most) fragments.emplace(point.pixels * point.pixels, point.fragments);
  }
  const auto by_pixels = upper_exponent(pixels), by_objects = upper_exponent(objects);
  if (!by_pixels || !by_objects) return std::nullopt;
  growth.over_pixels = *by_pixels;
  growth.over_objects = *by_objects;
  const auto &least = *fragments.begin(), &most_area = *fragments.rbegin();
  growth.fragments_per_pixel = (most_area.second - least.second) / (most_area.first - least.first);
  return growth;
}

std::string bottleneck_of(const Growth& growth, const Growth& none) {
  if (growth.fragments_per_pixel - none.fragments_per_pixel > many_fragments) return "fill rate";
  if (growth.over_pixels < hardly_grows && growth.over_objects > growth.over_pixels)
    return "geometry";
  return "shaders";
}

Agreement agreement(const std::vector<double>& ours, const std::vector<double>& theirs) {
  Agreement result;
  for (std::size_t a = 0; a < ours.size(); ++a)
    for (std::size_t b = a + 1; b < ours.size(); ++b) {
      if (ours[a] == ours[b] || theirs[a] == theirs[b]) continue;
      ++result.pairs;
      if ((ours[a] < ours[b]) == (theirs[a] < theirs[b])) ++result.agreeing;
    }
  return result;
}

}  // namespace penumbra::experiments
