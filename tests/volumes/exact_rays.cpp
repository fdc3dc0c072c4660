#include "tests/volumes/exact_rays.h"

#include "tests/volumes/drawing.h"

namespace penumbra::test {

std::vector<int> exact_visibility(const Scene& scene, const std::string& camera_name,
                                  std::uint32_t width) {
  const ExactRays rays(scene);
  const Camera& camera = scene.cameras[find_camera(scene, camera_name)];
  std::vector<int> visibility;
  for (std::uint32_t y = 0; y < width; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const Ray view = camera_ray(camera, x, y, width);
      const auto hit = rays.nearest(view.from, view.along, camera.near_plane);
      for (const Light& light : scene.lights) {
        if (!hit) {
          visibility.push_back(-1);
          continue;
        }
        const glm::dvec3 point = view.from + hit->distance * view.along;
        const glm::dvec3 to_light =
            light.kind == LightKind::directional ? -1e4 * light.direction : light.position - point;
        if (glm::dot(hit->normal, glm::normalize(to_light)) < 1e-6)
          visibility.push_back(-1);
        else
          visibility.push_back(rays.hidden(point, to_light, hit->triangle) ? 0 : 1);
      }
    }
  return visibility;
}

}  // namespace penumbra::test
