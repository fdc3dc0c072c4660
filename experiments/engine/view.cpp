#include "experiments/engine/view.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace penumbra::experiments {
namespace {

/// About the vertical axis (Y), counter-clockwise seen from above.
glm::dvec3 turned(const glm::dvec3& v, double degrees) {
  const double angle = degrees * glm::pi<double>() / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

std::string degrees_text(const char* what, double degrees) {
  const long whole = std::lround(degrees);
  return std::string(what) + (whole > 0 ? " +" : " ") + std::to_string(whole);
}

}  // namespace

std::string View::text() const {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (!camera.empty()) add("camera " + camera);
  if (camera_turn != 0.0) add(degrees_text("camera turned", camera_turn));
  if (light_turn != 0.0) add(degrees_text("lights turned", light_turn));
  return text;
}

Scene seen_from(const Scene& scene, const View& view) {
  Scene seen = scene;
  Camera& camera = seen.cameras[find_camera(seen, view.camera)];
  camera.position = camera.target + turned(camera.position - camera.target, view.camera_turn);
  camera.up = turned(camera.up, view.camera_turn);
  if (view.light_turn == 0.0) return seen;
  const glm::dvec3 middle = world_bounds(scene).center();
  for (Light& light : seen.lights) {
    light.position = middle + turned(light.position - middle, view.light_turn);
    light.direction = turned(light.direction, view.light_turn);
    light.up = turned(light.up, view.light_turn);
  }
  return seen;
}

}  // namespace penumbra::experiments
