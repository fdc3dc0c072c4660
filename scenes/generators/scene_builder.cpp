#include "scenes/generators/scene_builder.h"

#include <cmath>
#include <utility>

#include "scenes/generators/textures.h"

namespace penumbra::scenes {

SceneBuilder::SceneBuilder(const std::string& id, const std::string& title) {
  scene.id = id;
  scene.title = title;
}

int SceneBuilder::texture(const std::string& generator, std::uint32_t seed, std::uint32_t size) {
  const std::string name = generator + " " + std::to_string(seed);
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    if (scene.textures[i].name == name && scene.textures[i].width == size)
      return static_cast<int>(i);
  scene.textures.push_back(generate_texture(generator, size, seed));
  scene.textures.back().name = name;
  return static_cast<int>(scene.textures.size()) - 1;
}

Look SceneBuilder::look(const std::string& name, const glm::vec3& color, int texture_index,
                        double tile, float specular, float shininess) {
  Material material;
  material.name = name;
  material.base_color = color;
  material.texture = texture_index;
  material.specular = specular;
  material.shininess = shininess;
  scene.materials.push_back(material);
  return {static_cast<std::uint32_t>(scene.materials.size() - 1), tile};
}

std::uint32_t SceneBuilder::add_mesh(const std::string& name, Mesh mesh) {
  mesh.name = name;
  scene.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

void SceneBuilder::place(std::uint32_t mesh, const glm::dmat4& world_from_object,
                         const std::string& name) {
  scene.instances.push_back(
      {name.empty() ? scene.meshes[mesh].name : name, mesh, world_from_object, true});
}

void SceneBuilder::place(const Solid& solid, const Look& look_of, const std::string& name,
                         const glm::dmat4& world_from_object, double crease) {
  Mesh mesh;
  add_part(mesh, solid, look_of, glm::dmat4(1.0), crease);
  place(add_mesh(name, std::move(mesh)), world_from_object);
}

void SceneBuilder::ground(const glm::dvec2& low, const glm::dvec2& high, const Look& look_of,
                          const std::string& name, double thickness) {
  place(box({low.x, -thickness, low.y}, {high.x, 0.0, high.y}), look_of, name);
  scene.receivers.push_back(
      {name,
       {{low.x, 0.0, low.y}, {low.x, 0.0, high.y}, {high.x, 0.0, high.y}, {high.x, 0.0, low.y}}});
}

Light& SceneBuilder::spot(const std::string& name, const glm::dvec3& position,
                          const glm::dvec3& target, const glm::vec3& color, float intensity,
                          double outer_angle, const LightExtent& extent) {
  Light light;
  light.name = name;
  light.position = position;
  light.direction = glm::normalize(target - position);
  light.up = std::abs(light.direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  light.color = color;
  light.intensity = intensity;
  light.inner_angle = 0.82 * outer_angle;
  light.outer_angle = outer_angle;
  light.extent = extent;
  scene.lights.push_back(light);
  return scene.lights.back();
}

Light& SceneBuilder::sun(const glm::dvec3& direction, const glm::vec3& color, float intensity) {
  Light light;
  light.name = "sun";
  light.kind = LightKind::directional;
  light.direction = glm::normalize(direction);
  light.color = color;
  light.intensity = intensity;
  light.extent = disc(0.265);
  scene.lights.push_back(light);
  return scene.lights.back();
}

Camera& SceneBuilder::camera(const std::string& name, const glm::dvec3& position,
                             const glm::dvec3& target, double vertical_fov) {
  Camera camera;
  camera.name = name;
  camera.position = position;
  camera.target = target;
  camera.vertical_fov = vertical_fov;
  scene.cameras.push_back(camera);
  return scene.cameras.back();
}

void add_part(Mesh& mesh, const Solid& solid, const Look& look, const glm::dmat4& transform,
              double crease) {
  append(mesh, to_mesh(solid, crease, 1.0 / look.tile), transform, look.material);
}

LightExtent disc(double radius) {
  return {ExtentKind::disc, radius, glm::dvec2(0.0)};
}
LightExtent ball(double radius) {
  return {ExtentKind::sphere, radius, glm::dvec2(0.0)};
}
LightExtent rectangle(double width, double height) {
  return {ExtentKind::rectangle, 0.0, {width, height}};
}

}  // namespace penumbra::scenes
