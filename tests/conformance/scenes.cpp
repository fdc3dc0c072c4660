#include "tests/conformance/scenes.h"

namespace penumbra::test {

Renderer& renderer() {
  static Renderer shared({.device = "", .validation = true});
  return shared;
}

void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      glm::dvec3 normal(0.0), u(0.0), v(0.0);
      normal[axis] = side;
      u[(axis + 1) % 3] = 1.0;
      v = glm::cross(normal, u);
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const glm::dvec2 corner : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        const glm::dvec3 unit = normal + corner.x * u + corner.y * v;
        mesh.positions.push_back(glm::vec3(0.5 * (low + high) + 0.5 * unit * (high - low)));
        mesh.normals.push_back(glm::vec3(normal));
      }
      for (const std::uint32_t index : {0u, 1u, 2u, 0u, 2u, 3u})
        mesh.indices.push_back(first + index);
    }
  mesh.primitives.push_back({0, static_cast<std::uint32_t>(mesh.indices.size()), 0});
  Instance instance;
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(mesh);
  scene.instances.push_back(instance);
}

Scene open_ground() {
  Scene scene;
  scene.id = "open-ground";
  scene.materials.emplace_back();
  add_box(scene, {-2, -0.2, -2}, {2, 0, 2});
  Camera camera;
  camera.name = "above";
  camera.position = {0, 3, 0};
  camera.target = {0, 0, 0};
  camera.up = {0, 0, -1};
  camera.projection = Projection::orthographic;
  camera.orthographic_height = 2.0;
  scene.cameras.push_back(camera);
  Light light;
  light.name = "lamp";
  light.position = {0, 4, 0};
  light.direction = {0, -1, 0};
  light.inner_angle = 40;
  light.outer_angle = 45;
  light.extent.kind = ExtentKind::disc;
  light.extent.radius = 0.05;
  scene.lights.push_back(light);
  PlanarReceiver receiver;
  receiver.name = "ground";
  receiver.corners = {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}};
  scene.receivers.push_back(receiver);
  return scene;
}

Scene covered_ground() {
  Scene scene = open_ground();
  scene.id = "covered-ground";
  add_box(scene, {-2, 1, -2}, {2, 1.1, 2});
  // From the side, outside the shadow: z-pass volumes invert where the camera is in it.
  scene.cameras[0].position = {0, 0.7, 5};
  scene.cameras[0].target = {0, 0.2, 0};
  scene.cameras[0].up = {0, 1, 0};
  scene.cameras[0].projection = Projection::perspective;
  scene.cameras[0].vertical_fov = 25.0;
  return scene;
}

Scene box_on_ground() {
  Scene scene = open_ground();
  scene.id = "box-on-ground";
  // A hair above the ground: touching faces belong to neither body.
  add_box(scene, {-0.25, 0.001, -0.25}, {0.25, 0.5, 0.25});
  scene.lights[0].position = {1.5, 4, 0.7};
  scene.lights[0].direction = glm::normalize(glm::dvec3(-1.5, -4, -0.7));
  return scene;
}

}  // namespace penumbra::test
