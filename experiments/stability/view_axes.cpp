// Axes of the camera and the picture.
#include <cmath>

#include "experiments/stability/axes.h"
#include "experiments/stability/subjects.h"

namespace penumbra::experiments::stability {
namespace {

/// A trial of the subject scene with its camera changed while all is upright.
Axis view_axis(const std::string& id, const std::string& title, const std::string& unit,
               std::vector<double> values, const std::function<void(Camera&, double)>& change) {
  return {id, title, unit, std::move(values), [change](double value) {
            Scene scene = subject();
            change(scene.cameras[0], value);
            return Trial{.scene = askew(std::move(scene))};
          }};
}

Axis size_axis(const std::string& id, const std::string& title, std::vector<double> values,
               bool square) {
  Axis axis{id, title, "pixels", std::move(values), [square](double value) {
              Trial trial{.scene = askew(subject())};
              trial.width = static_cast<std::uint32_t>(value);
              trial.height = square ? trial.width : 8;
              return trial;
            }};
  axis.whole = true;
  return axis;
}

/// Seen from above without perspective, `height` metres of the scene.
void look_without_perspective(Scene& scene, double height) {
  scene.cameras[0].projection = Projection::orthographic;
  scene.cameras[0].orthographic_height = height;
}

void add_perspective_axes(std::vector<Axis>& axes) {
  axes.push_back(view_axis("zoom", "field of view on the border of a shadow", "degrees",
                           {40.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.01, 1e-3},
                           [](Camera& camera, double degrees) {
                             camera.target = shadow_border();
                             camera.vertical_fov = degrees;
                           }));
  axes.push_back(view_axis(
      "dolly", "field of view of a camera that goes away as it shrinks", "degrees",
      {40.0, 10.0, 1.0, 0.1, 1e-2, 1e-3}, [](Camera& camera, double degrees) {
        const double factor = std::tan(glm::radians(20.0)) / std::tan(glm::radians(0.5 * degrees));
        camera.position = camera.target + factor * (camera.position - camera.target);
        camera.vertical_fov = degrees;
      }));
  axes.push_back(view_axis("wide-view", "wide field of view", "degrees",
                           {40.0, 90.0, 120.0, 150.0, 170.0, 179.0, 179.9},
                           [](Camera& camera, double degrees) { camera.vertical_fov = degrees; }));
  axes.push_back(view_axis("near", "distance of the camera's near plane", "m",
                           {0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9},
                           [](Camera& camera, double value) { camera.near_plane = value; }));
  axes.push_back(view_axis(
      "camera-elevation", "elevation of the camera over the ground", "degrees",
      {30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.01, 1e-3}, [](Camera& camera, double degrees) {
        const double e = glm::radians(degrees);
        camera.target = {0.1, 0.0, 0.0};
        camera.position =
            camera.target + 6.0 * glm::dvec3(0.45 * std::cos(e), std::sin(e), 0.893 * std::cos(e));
      }));
}

void add_orthographic_axes(std::vector<Axis>& axes) {
  axes.push_back({"orthographic-scale",
                  "scene made smaller, without perspective",
                  "times",
                  {1.0, 1e-2, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8},
                  [](double factor) {
                    Scene scene = subject();
                    look_without_perspective(scene, 4.5);
                    const Scene still = askew(std::move(scene));
                    return Trial{.scene = moved(still, factor, 0.0, {}), .unmoved = still};
                  }});
  axes.push_back({"orthographic-outlier",
                  "distance of an object out of sight, without perspective",
                  "m",
                  {0.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e8},
                  [](double distance) {
                    Scene scene = subject({.outlier = distance});
                    look_without_perspective(scene, 4.5);
                    return Trial{.scene = askew(std::move(scene))};
                  }});
  axes.push_back({"orthographic-height",
                  "height of the view without perspective, on the border of a shadow",
                  "m",
                  {4.5, 1.0, 1e-1, 1e-2, 1e-3, 1e-4},
                  [](double height) {
                    Scene scene = subject();
                    Camera& camera = scene.cameras[0];
                    const glm::dvec3 way = camera.target - camera.position;
                    camera.target = shadow_border();
                    camera.position = camera.target - way;
                    look_without_perspective(scene, height);
                    return Trial{.scene = askew(std::move(scene))};
                  }});
}

}  // namespace

void add_view_axes(std::vector<Axis>& axes) {
  add_perspective_axes(axes);
  add_orthographic_axes(axes);
  axes.push_back(size_axis("small-picture", "pictures of few pixels", {96, 32, 8, 2, 1}, true));
  axes.push_back(size_axis("wide-picture", "pictures 8 pixels high", {96, 512, 2048, 8192}, false));
}

}  // namespace penumbra::experiments::stability
