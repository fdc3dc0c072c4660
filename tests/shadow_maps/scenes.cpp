#include "scenes.h"

namespace penumbra::tests {
namespace {

void add_faces(Scene& scene, Mesh mesh, bool casts_shadow) {
  mesh.primitives.push_back({0, static_cast<std::uint32_t>(mesh.indices.size()), 0});
  Instance instance;
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  instance.casts_shadow = casts_shadow;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back(instance);
}

void add_face(Mesh& mesh, const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::dvec2 corner : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    mesh.positions.push_back(glm::vec3(center + corner.x * u + corner.y * v));
    mesh.normals.push_back(glm::vec3(glm::normalize(glm::cross(u, v))));
    mesh.uvs.push_back(glm::vec2(0.5 + 0.5 * corner));
  }
  for (const std::uint32_t index : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + index);
}

}  // namespace

Scene empty_scene(double camera_height, double width) {
  Scene scene;
  scene.id = "hand-made";
  scene.materials.emplace_back();
  scene.materials[0].double_sided = true;
  Camera camera;
  camera.name = "above";
  camera.position = {0, camera_height, 0};
  camera.target = {0, 0, 0};
  camera.up = {0, 0, -1};
  camera.projection = Projection::orthographic;
  camera.orthographic_height = width;
  camera.near_plane = 0.01;
  scene.cameras.push_back(camera);
  return scene;
}

void add_plate(Scene& scene, const glm::dvec2& low, const glm::dvec2& high, double y,
               bool casts_shadow) {
  Mesh mesh;
  const glm::dvec2 center = 0.5 * (low + high), half = 0.5 * (high - low);
  add_face(mesh, {center.x, y, center.y}, {half.x, 0, 0}, {0, 0, -half.y});
  add_faces(scene, std::move(mesh), casts_shadow);
}

void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high) {
  Mesh mesh;
  const glm::dvec3 center = 0.5 * (low + high), half = 0.5 * (high - low);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      glm::dvec3 normal(0.0), u(0.0);
      normal[axis] = side;
      u[(axis + 1) % 3] = 1.0;
      add_face(mesh, center + normal * half, u * half, glm::cross(normal, u) * half);
    }
  add_faces(scene, std::move(mesh), true);
}

Light sun() {
  Light light;
  light.name = "sun";
  light.kind = LightKind::directional;
  light.direction = {0, -1, 0};
  return light;
}

Light lamp(const glm::dvec3& position, double half_angle) {
  Light light;
  light.name = "lamp";
  light.position = position;
  light.direction = {0, -1, 0};
  light.outer_angle = half_angle;
  light.inner_angle = half_angle - 0.01;
  return light;
}

}  // namespace penumbra::tests
