#pragma once

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "scenes/generators/scene_builder.h"
#include "scenes/library.h"
#include "techniques/registry.h"

/// Drawing small pictures and asking where their pixels lie in the world.
namespace penumbra::test {

constexpr std::uint32_t size = 160;

inline Renderer& renderer() {
  static Renderer shared({.device = "", .validation = true});
  return shared;
}

inline RenderResult draw(const Scene& scene, const std::string& technique,
                         const ParameterValues& parameters = {}, const std::string& camera = {},
                         std::uint32_t width = size) {
  const auto resolved = techniques::resolve(technique, parameters);
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(scene);
  request.camera = camera;
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = width;
  request.visibility = true;
  return renderer().render(request);
}

struct Ray {
  glm::dvec3 from;
  glm::dvec3 along;  ///< perspective: at depth 1; otherwise unit
};

/// Through the middle of a pixel of a square picture.
inline Ray camera_ray(const Camera& camera, std::uint32_t x, std::uint32_t y, std::uint32_t width) {
  const glm::dvec3 forward = glm::normalize(camera.target - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const glm::dvec3 across =
      (2.0 * (x + 0.5) / width - 1.0) * right + (1.0 - 2.0 * (y + 0.5) / width) * up;
  if (camera.projection == Projection::orthographic)
    return {camera.position + 0.5 * camera.orthographic_height * across, forward};
  return {camera.position, forward + std::tan(glm::radians(0.5 * camera.vertical_fov)) * across};
}

/// Where that ray meets the plane y = 0, in a picture of the default size.
inline glm::dvec3 ground_point(const Camera& camera, std::uint32_t x, std::uint32_t y) {
  const Ray ray = camera_ray(camera, x, y, size);
  return ray.from - ray.along * (ray.from.y / ray.along.y);
}

/// Whether the segment between two points touches a box.
inline bool meets_box(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& low,
                      const glm::dvec3& high) {
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = to[axis] - from[axis];
    if (d == 0.0) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) return false;
      continue;
    }
    const double a = (low[axis] - from[axis]) / d;
    const double b = (high[axis] - from[axis]) / d;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

}  // namespace penumbra::test
