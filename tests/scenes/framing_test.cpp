// What is added to files without lights and cameras, judged by the geometry of the file.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/generators/scene_builder.h"
#include "scenes/import/import.h"

namespace penumbra::scenes {
namespace {

void place(SceneBuilder& b, const Solid& solid, bool double_sided = false) {
  const Look look = b.look("grey", glm::vec3(0.7f));
  b.scene.materials[look.material].double_sided = double_sided;
  b.place(solid, look, "solid");
}

/// A rectangle on the ground or above that looks up, or down.
void add_level(Scene& scene, double half, double y, bool up, bool double_sided = false) {
  Material material;
  material.double_sided = double_sided;
  scene.materials.push_back(material);
  Mesh mesh;
  for (const glm::vec2 corner : {glm::vec2(-1, -1), {-1, 1}, {1, 1}, {1, -1}}) {
    mesh.positions.push_back({corner.x * half, y, corner.y * half});
    mesh.normals.push_back({0, up ? 1 : -1, 0});
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  if (!up) mesh.indices = {0, 2, 1, 0, 3, 2};
  mesh.primitives.push_back({0, 6, static_cast<std::uint32_t>(scene.materials.size() - 1)});
  scene.meshes.push_back(mesh);
  scene.instances.push_back(
      {"level", static_cast<std::uint32_t>(scene.meshes.size() - 1), glm::dmat4(1.0), true});
}

/// Height of the ground that was added, or NaN.
double ground_height(const Scene& scene) {
  for (const Instance& instance : scene.instances)
    if (instance.name == "ground") return instance.world_from_object[3].y;
  return std::nan("");
}

TEST(Framing, AddsAGroundClearlyBelowABody) {
  for (const double size : {1e-3, 1.0, 1e4}) {
    SceneBuilder b("cube", "A cube");
    place(b, box({-size, -size, -size}, {size, size, size}));
    complete_import(b.scene);
    const double gap = (-size - ground_height(b.scene)) / size;
    EXPECT_GT(gap, 1e-3) << size;
    EXPECT_LT(gap, 1e-2) << size;
  }
}

TEST(Framing, AddsNoGroundWhereTheFileBringsOne) {
  SceneBuilder b("cube", "A cube on a plane");
  place(b, box({-1.0, 0.01, -1.0}, {1.0, 2.0, 1.0}));
  add_level(b.scene, 5.0, 0.0, true);
  complete_import(b.scene);
  EXPECT_TRUE(std::isnan(ground_height(b.scene)));
  EXPECT_EQ(b.scene.lights.size(), 1u);
}

TEST(Framing, AddsNoGroundToARoomThatIsSeenFromWithin) {
  SceneBuilder b("room", "A floor and a ceiling, wound outwards");
  add_level(b.scene, 1.0, 0.0, false, true);
  add_level(b.scene, 1.0, 2.0, true, true);
  complete_import(b.scene);
  EXPECT_TRUE(std::isnan(ground_height(b.scene)));
}

TEST(Framing, TakesNeitherAnUndersideNorASmallFootForAFloor) {
  SceneBuilder closed("cube", "A closed body of a double-sided material");
  place(closed, box({-1.0, 0.0, -1.0}, {1.0, 2.0, 1.0}), true);
  complete_import(closed.scene);
  EXPECT_FALSE(std::isnan(ground_height(closed.scene)));
  SceneBuilder table("table", "A board over a small foot");
  place(table, box({-1.0, 1.0, -1.0}, {1.0, 1.1, 1.0}));
  add_level(table.scene, 0.2, 0.0, true);
  complete_import(table.scene);
  EXPECT_FALSE(std::isnan(ground_height(table.scene)));
}

TEST(Framing, DoesNotFollowAStrayVertex) {
  for (const double far : {1e4, 1e9}) {
    SceneBuilder b("cube", "A cube"), s("cube", "A cube with a stray vertex");
    place(b, box({-0.5, 0.3, -0.5}, {0.5, 1.3, 0.5}));
    place(s, box({-0.5, 0.3, -0.5}, {0.5, 1.3, 0.5}));
    Mesh& mesh = s.scene.meshes[0];
    mesh.positions.push_back({0.0, far, 0.0});
    mesh.normals.push_back({0, 1, 0});
    complete_import(b.scene);
    complete_import(s.scene);
    EXPECT_LT(glm::length(s.scene.cameras[0].position - b.scene.cameras[0].position), 0.05) << far;
    EXPECT_LT(glm::length(s.scene.lights[0].position - b.scene.lights[0].position), 0.05) << far;
    EXPECT_NEAR(ground_height(s.scene), ground_height(b.scene), 1e-6) << far;
  }
}

}  // namespace
}  // namespace penumbra::scenes
