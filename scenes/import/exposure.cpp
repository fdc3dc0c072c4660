#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/scene/light.h"
#include "scenes/import/gltf.h"
#include "scenes/import/seen_points.h"

namespace penumbra::scenes::gltf {
namespace {

constexpr int metered_side = 32;  // cells along a side of the metered picture

/// What a light brings to a point, lux by its brightest channel; without a normal as if it faced
/// the light, inside its cone. Shadows are left out: exposure must not depend on a technique.
double illuminance(const Light& light, const glm::dvec3& point, const glm::dvec3* normal) {
  const double brightness =
      static_cast<double>(light.intensity) *
      static_cast<double>(std::max({light.color.x, light.color.y, light.color.z}));
  const glm::dvec4 center = center_of(light);
  const glm::dvec3 offset = glm::dvec3(center) - center.w * point;
  const double distance = glm::length(offset);
  if (!(distance > 0.0)) return 0.0;
  const double arriving = brightness * attenuation_at(light, distance);
  if (normal == nullptr) return arriving;
  const glm::dvec3 to_light = offset / distance;
  return arriving * cone_strength(light, to_light) * std::max(glm::dot(*normal, to_light), 0.0);
}

double illuminance(const Scene& scene, const glm::dvec3& point, const glm::dvec3* normal) {
  double sum = 0.0;
  for (const Light& light : scene.lights) sum += illuminance(light, point, normal);
  return std::isfinite(sum) ? sum : 0.0;
}

/// The illuminance that only a tenth of the light in the picture exceeds. Weighted by light, so
/// that dark distances do not count, however much of the picture they fill; a weight is no more
/// than four times the median's, so that a small spot right beside a lamp does not count either.
/// The median is that of what is no darker than a 256th of the brightest, a twentieth left aside.
double bright_part(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double dark = values[values.size() * 19 / 20] / 256.0;
  values.erase(values.begin(), std::lower_bound(values.begin(), values.end(), dark));
  const double most = 4.0 * values[values.size() / 2];
  const double total =
      std::accumulate(values.begin(), values.end(), 0.0,
                      [&](double sum, double v) { return sum + std::min(v, most); });
  double sum = 0.0;
  for (const double value : values) {
    sum += std::min(value, most);
    if (sum >= 0.9 * total) return value;
  }
  return values.back();
}

/// 0 where no light reaches anything.
double metered(const Scene& scene) {
  std::vector<double> lit;
  for (const SeenPoint& point : seen_points(scene, scene.cameras.front(), metered_side)) {
    const double value = illuminance(scene, point.position, &point.normal);
    if (value > 0.0) lit.push_back(value);
  }
  if (!lit.empty()) return bright_part(std::move(lit));
  // The camera sees no lit surface: what the lights bring to the middle of all, facing them.
  const Bounds bounds = world_bounds(scene);
  return illuminance(scene, bounds.empty() ? glm::dvec3(0.0) : bounds.center(), nullptr);
}

}  // namespace

void expose(Scene& scene) {
  const double bright = metered(scene);
  if (!(bright > 0.0)) return;
  // White there comes out a little above 1.
  scene.exposure = static_cast<float>(std::clamp(1.2 / bright, 1e-8, 1e8));
  scene.ambient /= scene.exposure;
  scene.background_low /= scene.exposure;
  scene.background_high /= scene.exposure;
  scene.notes.push_back(
      "the lights are in candela and lux: exposure was set to " + std::to_string(scene.exposure) +
      " (" + std::to_string(std::log2(scene.exposure)) + " EV) for what the first camera sees");
  scene.notes.push_back(
      "glTF lights have no extent: their shadows are hard unless a request gives one");
}

}  // namespace penumbra::scenes::gltf
