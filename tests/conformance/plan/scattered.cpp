#include "tests/conformance/plan/scattered.h"

#include <random>

#include "tests/conformance/scenes.h"

namespace penumbra::test {
namespace {

Light lamp(const std::string& name, const glm::dvec3& position, const glm::dvec3& target,
           double angle) {
  Light light;
  light.name = name;
  light.position = position;
  light.direction = glm::normalize(target - position);
  light.up = {0.3, 0.2, 0.9};
  light.inner_angle = 0.8 * angle;
  light.outer_angle = angle;
  light.intensity = 0.5f;
  light.extent = {ExtentKind::rectangle, 0.0, {0.3, 0.2}};
  return light;
}

}  // namespace

Scene scattered(std::uint32_t seed) {
  std::mt19937 generator(seed);
  // The library's distributions differ between implementations; this does not.
  const auto random = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(generator()) / 4294967295.0);
  };
  Scene scene;
  scene.id = "scattered-" + std::to_string(seed);
  add_box(scene, {-12, -0.3, -12}, {12, 0, 12});
  for (int i = 0; i < 24; ++i) {
    const glm::dvec3 at(random(-10, 10), random(0.3, 4.0), random(-10, 10));
    const glm::dvec3 half(random(0.1, 0.5), random(0.1, 0.3), random(0.1, 0.5));
    add_box(scene, at - half, at + half);
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    Texture texture{"paint " + std::to_string(i), 1, 1, {}};
    for (int c = 0; c < 3; ++c)
      texture.rgba.push_back(static_cast<std::uint8_t>(random(100.0, 255.0)));
    texture.rgba.push_back(255);
    scene.textures.push_back(texture);
    Material material;
    material.texture = static_cast<int>(i);
    scene.materials.push_back(material);
    scene.instances[i].name = "box " + std::to_string(i);
    scene.meshes[scene.instances[i].mesh].primitives[0].material = static_cast<std::uint32_t>(i);
    scene.meshes[scene.instances[i].mesh].uvs.assign(
        scene.meshes[scene.instances[i].mesh].positions.size(), glm::vec2(0.5f));
  }
  Camera camera;
  camera.name = "main";
  camera.position = {random(-4, 4), random(2.0, 3.5), 6.0};
  camera.target = {random(-2, 2), 0.0, -1.0};
  camera.vertical_fov = random(20.0, 45.0);
  scene.cameras.push_back(camera);
  scene.lights.push_back(
      lamp("key", {random(-4, 4), 7.0, random(-4, 4)}, camera.target, random(12.0, 35.0)));
  scene.lights.push_back(lamp("stray", {random(-10, 10), random(1.0, 8.0), random(-10, 10)},
                              {random(-10, 10), 0.0, random(-10, 10)}, random(5.0, 20.0)));
  if (seed % 2 == 0) scene.lights.back().range = random(2.0, 8.0);
  Light sun = lamp("sun", {}, {random(-1, 1), -1.0, random(-1, 1)}, 1.0);
  sun.kind = LightKind::directional;
  sun.extent = {ExtentKind::disc, 1.0, {}};
  scene.lights.push_back(sun);
  PlanarReceiver receiver;
  receiver.name = "ground";
  receiver.corners = {{-12, 0, -12}, {-12, 0, 12}, {12, 0, 12}, {12, 0, -12}};
  scene.receivers.push_back(receiver);
  return scene;
}

}  // namespace penumbra::test
