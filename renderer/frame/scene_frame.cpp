#include <algorithm>
#include <cmath>
#include <cstdio>

#include "renderer/frame/gpu_scene.h"

namespace penumbra {
namespace {

/// Scenes this many times as large as what is near the camera are counted from their middle: floats
/// there are in steps of 2e-5 of that distance, far below a pixel.
constexpr double largest_share = 128.0;

/// Below this many near planes no look at the vertices is needed.
constexpr double surely_fine = 8192.0;

constexpr std::size_t most_looked_at = 65536;

/// The distance within which a quarter of the vertices lie, metres. A stray vertex does not change
/// it, nor does a distant object, if there is about as much near the camera.
double near_distance(const Scene& scene, const Camera& camera) {
  std::size_t vertices = 0;
  for (const Instance& instance : scene.instances)
    vertices += scene.meshes[instance.mesh].positions.size();
  const std::size_t step = vertices / most_looked_at + 1;
  std::vector<double> distances;
  for (const Instance& instance : scene.instances) {
    const auto& positions = scene.meshes[instance.mesh].positions;
    for (std::size_t v = 0; v < positions.size(); v += step)
      distances.push_back(
          glm::length(glm::dvec3(instance.world_from_object * glm::dvec4(positions[v], 1.0)) -
                      camera.position));
  }
  const auto quarter = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 4);
  std::nth_element(distances.begin(), quarter, distances.end());
  return std::max(*quarter, camera.near_plane);
}

/// A power of two keeps the bits of coordinates that are multiples of it; no more than a metre.
double rounding_step(double size) {
  return std::exp2(std::floor(std::log2(std::clamp(size, 1e-30, 1.0))));
}

std::string in_metres(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g m", value);
  return text;
}

/// Distance between neighbouring floats of this size.
double float_step(double value) {
  return std::ldexp(1.0, std::ilogb(std::max(value, 1e-30)) - 23);
}

}  // namespace

SceneFrame scene_frame(const Scene& scene, const Camera& camera) {
  const Bounds bounds = world_bounds(scene);
  if (bounds.empty()) return {};
  const double radius = bounds.radius();
  const double step = rounding_step(radius);
  const SceneFrame middle{step * glm::round(bounds.center() / step)};
  if (radius <= surely_fine * camera.near_plane) return middle;
  const double near = near_distance(scene, camera);
  if (radius <= largest_share * near) return middle;
  const double small_step = rounding_step(near);
  return {small_step * glm::round(camera.position / small_step), largest_share * near};
}

Bounds GpuScene::near_part(const Bounds& box) const {
  const Bounds part{glm::max(box.low - frame_.origin, glm::dvec3(-frame_.reach)),
                    glm::min(box.high - frame_.origin, glm::dvec3(frame_.reach))};
  return part.low.y <= part.high.y && part.low.z <= part.high.z ? part : Bounds{};
}

float GpuScene::inverse_size() const {
  const glm::vec3 sides = high_ - low_;
  const float size = std::max({sides.x, sides.y, sides.z});
  return size > 0.0f ? std::exp2(-std::floor(std::log2(size))) : 1.0f;
}

void GpuScene::find_coarse_coordinates() {
  if (is_far()) {
    const double size = 2.0 * world_bounds(*scene_).radius();
    notes_.push_back("the scene reaches " + in_metres(size) +
                     ": coordinates are counted from the camera, in steps of " +
                     in_metres(float_step(size)) + " at its far end, and shadows are fitted to " +
                     in_metres(frame_.reach) + " around the camera");
  }
  // A file's own floats may be too coarse for what they describe, wherever they are counted from.
  constexpr double coarse = 1e-4;
  double worst = 0.0;
  for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
    const Instance& instance = scene_->instances[i];
    Bounds object;
    for (const glm::vec3& position : scene_->meshes[instance.mesh].positions)
      object.add(glm::dvec3(position));
    if (object.empty()) continue;
    const glm::dvec3 largest = glm::max(glm::abs(object.low), glm::abs(object.high));
    const double step = float_step(std::max({largest.x, largest.y, largest.z}));
    const double size = 2.0 * object.radius();
    if (size > 0.0 && step > coarse * size)
      worst = std::max(worst, step * glm::length(glm::dvec3(instance.world_from_object[0])));
  }
  if (worst > 0.0)
    notes_.push_back("coordinates of a mesh are far from its origin: they are in steps of " +
                     in_metres(worst) + ", which its surface shows");
}

}  // namespace penumbra
