// Axes of the light.
#include <cmath>

#include "experiments/stability/axes.h"
#include "experiments/stability/subjects.h"

namespace penumbra::experiments::stability {
namespace {

const glm::dvec3 scene_middle{0.0, 0.5, 0.0};

/// A trial of the subject scene with its light changed while all is upright.
Axis light_axis(const std::string& id, const std::string& title, const std::string& unit,
                std::vector<double> values, const std::function<void(Scene&, double)>& change) {
  return {id, title, unit, std::move(values), [change](double value) {
            Scene scene = subject();
            change(scene, value);
            return Trial{.scene = askew(std::move(scene))};
          }};
}

/// Moves the light to a distance from the scene's middle, on its line from there.
void put_at(Light& light, double distance) {
  light.position = scene_middle + distance * glm::normalize(light.position - scene_middle);
  light.direction = glm::normalize(scene_middle - light.position);
}

/// A soft trial: an area light that faces straight down, so that its points all face the ground.
Axis extent_axis(const std::string& id, const std::string& title, ExtentKind kind,
                 std::vector<double> values) {
  return {id, title, "m", std::move(values), [kind](double value) {
            Scene scene = subject();
            Light& light = scene.lights[0];
            light.extent = {kind, value, glm::dvec2(2.0 * value, 0.0)};
            light.direction = {0.0, -1.0, 0.0};
            light.up = {0.0, 0.0, 1.0};
            light.outer_angle = 60.0;
            light.inner_angle = 55.0;
            return Trial{
                .scene = askew(std::move(scene)), .width = 48, .height = 48, .points = 256};
          }};
}

void add_distances(std::vector<Axis>& axes) {
  axes.push_back(light_axis("spot-distance", "distance of a spot whose cone fits the scene", "m",
                            {7.0, 30.0, 1e2, 1e3, 1e4, 1e5, 1e6}, [](Scene& scene, double d) {
                              Light& light = scene.lights[0];
                              put_at(light, d);
                              light.outer_angle = glm::degrees(std::atan(4.9 / d));
                              light.inner_angle = 0.82 * light.outer_angle;
                            }));
  axes.push_back(light_axis("point-distance", "distance of a point light", "m",
                            {7.0, 30.0, 1e2, 1e3, 1e4, 1e5, 1e6}, [](Scene& scene, double d) {
                              scene.lights[0].kind = LightKind::point;
                              put_at(scene.lights[0], d);
                            }));
  axes.push_back(light_axis("light-height", "height of a point light over the ground", "m",
                            {3.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-6}, [](Scene& scene, double h) {
                              scene.lights[0].kind = LightKind::point;
                              scene.lights[0].position = {1.6, h, 1.4};
                            }));
  axes.push_back(light_axis(
      "elevation", "elevation of the sun", "degrees",
      {60.0, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.01, 0.001}, [](Scene& scene, double degrees) {
        const double e = glm::radians(degrees);
        Light& light = scene.lights[0];
        light.kind = LightKind::directional;
        light.direction = -glm::dvec3(-0.6 * std::cos(e), std::sin(e), 0.8 * std::cos(e));
        light.up = {0.0, 1.0, 0.0};
        if (degrees > 45.0) light.up = {1.0, 0.0, 0.0};
      }));
}

}  // namespace

void add_light_axes(std::vector<Axis>& axes) {
  add_distances(axes);
  axes.push_back(light_axis(
      "cone", "half angle of a narrow cone, seen as large as it is", "degrees",
      {20.0, 10.0, 1.0, 0.3, 0.1, 0.05, 0.02, 0.01, 1e-3}, [](Scene& scene, double degrees) {
        // Aimed at the shadow's border behind the crate; the camera's field shrinks with it.
        Light& light = scene.lights[0];
        const glm::dvec3 aim = shadow_border();
        light.direction = glm::normalize(aim - light.position);
        light.outer_angle = degrees;
        light.inner_angle = 0.82 * degrees;
        Camera& camera = scene.cameras[0];
        const double reach = glm::length(aim - light.position) * std::tan(glm::radians(degrees));
        camera.target = aim;
        camera.vertical_fov =
            2.0 * glm::degrees(std::atan(0.8 * reach / glm::length(aim - camera.position)));
      }));
  axes.push_back(light_axis("wide-cone", "half angle of a wide cone", "degrees",
                            {35.0, 60.0, 75.0, 85.0, 89.0, 89.9, 89.999},
                            [](Scene& scene, double degrees) {
                              scene.lights[0].outer_angle = degrees;
                              scene.lights[0].inner_angle = 0.82 * degrees;
                            }));
  axes.push_back(light_axis(
      "intensity", "strength of the light", "times", {1.0, 1e3, 1e6, 1e10, 1e20, 1e30},
      [](Scene& scene, double value) { scene.lights[0].intensity = static_cast<float>(value); }));
  axes.push_back(extent_axis("disc", "radius of a disc", ExtentKind::disc,
                             {0.1, 0.3, 1.0, 3.0, 1e1, 1e2, 1e4, 1e9}));
  axes.push_back(extent_axis("line", "half length of a line light", ExtentKind::rectangle,
                             {0.1, 0.3, 1.0, 3.0, 1e1}));
}

}  // namespace penumbra::experiments::stability
