#include <algorithm>
#include <cmath>

#include "scenes/generators/scene_builder.h"
#include "scenes/import/import.h"
#include "scenes/import/model_bounds.h"

namespace penumbra::scenes {
namespace {

/// Between model and ground, as a share of the model's radius.
constexpr double ground_gap = 2e-3;

/// Slab of grey under the model, wide enough for its shadow.
void add_ground(Scene& scene, const Bounds& model) {
  const double radius = model.radius();
  // Clearly below: in one plane with a face of the model, both would be seen in turn.
  const double reach = 4.0 * radius, top = model.low.y - ground_gap * radius;
  Material grey;
  grey.name = "ground";
  grey.base_color = glm::vec3(0.6f);
  scene.materials.push_back(grey);
  // In its own space the slab is 2 wide, so that a coordinate far from the origin loses no bits.
  Mesh mesh;
  append(mesh, to_mesh(box({-1.0, -0.05, -1.0}, {1.0, 0.0, 1.0}), 30.0), glm::dmat4(1.0),
         static_cast<std::uint32_t>(scene.materials.size() - 1));
  mesh.name = "ground";
  scene.meshes.push_back(std::move(mesh));
  glm::dmat4 place(1.0);
  place[0].x = place[1].y = place[2].z = reach;
  place[3] = glm::dvec4(model.center().x, top, model.center().z, 1.0);
  scene.instances.push_back(
      {"ground", static_cast<std::uint32_t>(scene.meshes.size() - 1), place, true});
  const glm::dvec3 c(model.center().x, top, model.center().z);
  scene.receivers.push_back({"ground",
                             {c + glm::dvec3(-reach, 0, -reach), c + glm::dvec3(-reach, 0, reach),
                              c + glm::dvec3(reach, 0, reach), c + glm::dvec3(reach, 0, -reach)}});
  scene.notes.push_back("a grey ground was added under the model to receive its shadow");
}

void add_light(Scene& scene, const Bounds& model) {
  const double radius = model.radius();
  Light light;
  light.name = "key light";
  light.position = model.center() + radius * glm::dvec3(-2.0, 3.6, 2.2);
  light.direction = glm::normalize(model.center() - light.position);
  light.color = {1.0f, 0.97f, 0.92f};
  light.intensity = 1.1f;
  light.inner_angle = 24.0;
  light.outer_angle = 36.0;
  light.extent = disc(0.18 * radius);
  scene.lights.push_back(light);
  scene.notes.push_back("the file has no lights: a key light was added above, to the left");
}

void add_camera(Scene& scene, const Bounds& model, std::size_t strays) {
  const double radius = model.radius();
  Camera camera;
  camera.name = "default";
  camera.target = model.center();
  camera.vertical_fov = 40.0;
  const glm::dvec3 from = glm::normalize(glm::dvec3(0.62, 0.48, 0.85));
  // The ball around the model touches the frame's edges at radius / sin(20 degrees).
  camera.position = model.center() + 1.05 * radius / 0.3420201433256687 * from;
  camera.near_plane = 0.01 * radius;
  scene.cameras.push_back(camera);
  scene.notes.push_back(
      "the file has no camera: one was added that frames everything" +
      (strays > 0 ? " but " + std::to_string(strays) + " far vertices" : std::string()));
}

}  // namespace

void complete_import(Scene& scene) {
  const Model measured = measure_model(scene);
  Bounds model = measured.bounds;
  // A single point or a file without triangles still gets a camera that validates.
  if (model.empty()) model.add(glm::dvec3(0.0));
  if (model.radius() < 1e-12) {
    model.add(model.center() + 1e-3);
    model.add(model.center() - 1e-3);
  }
  if (scene.cameras.empty()) add_camera(scene, model, measured.strays);
  if (!scene.lights.empty()) return;
  const glm::dvec3 size = model.size();
  // What is flat and level is a ground already.
  if (!measured.has_floor && size.y > 0.15 * std::max(size.x, size.z)) add_ground(scene, model);
  add_light(scene, model);
}

}  // namespace penumbra::scenes
