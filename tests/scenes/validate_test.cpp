#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scenes/library.h"
#include "tests/scenes/gltf_file.h"

namespace penumbra {
namespace {

using scenes::test::error_of;
using testing::HasSubstr;

struct Fault {
  const char* named;
  std::function<void(Scene&)> apply;
};

TEST(Validate, NamesTheElementAtFault) {
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<Fault> faults = {
      {"textures[0] 'tiles 8': rgba", [](Scene& s) { s.textures[0].rgba.pop_back(); }},
      {"materials[1] 'wood': texture", [](Scene& s) { s.materials[1].texture = 7; }},
      {"materials[0]", [](Scene& s) { s.materials[0].base_color.x = NAN; }},
      {"meshes[1] 'standing': needs one normal", [](Scene& s) { s.meshes[1].normals.pop_back(); }},
      {"meshes[1] 'standing': has a normal", [](Scene& s) { s.meshes[1].normals[0] *= 2.0f; }},
      {"meshes[1] 'standing': has a position",
       [](Scene& s) { s.meshes[1].positions[0].y = INFINITY; }},
      {"meshes[1] 'standing': has an index", [](Scene& s) { s.meshes[1].indices[5] = 24; }},
      {"meshes[1] 'standing': has indices of", [](Scene& s) { s.meshes[1].indices.push_back(0); }},
      {"meshes[1] 'standing': has a primitive beyond",
       [](Scene& s) { s.meshes[1].primitives[0].first_index = 4294967295u; }},
      {"instances[0] 'ground': mesh", [](Scene& s) { s.instances[0].mesh = 99; }},
      {"instances[0] 'ground': world_from_object has no inverse",
       [](Scene& s) { s.instances[0].world_from_object[0] = glm::dvec4(0); }},
      {"lights[0] 'lamp': position", [=](Scene& s) { s.lights[0].position.x = infinite; }},
      {"lights[0] 'lamp': direction", [](Scene& s) { s.lights[0].direction *= 2.0; }},
      {"lights[0] 'lamp': up", [](Scene& s) { s.lights[0].up = s.lights[0].direction; }},
      {"lights[0] 'lamp': outer_angle", [](Scene& s) { s.lights[0].outer_angle = 90.0; }},
      {"lights[0] 'lamp': inner_angle", [](Scene& s) { s.lights[0].inner_angle = 60.0; }},
      {"lights[1] 'lamp': has a name", [](Scene& s) { s.lights.push_back(s.lights[0]); }},
      {"cameras[0] 'main': position", [](Scene& s) { s.cameras[0].position.y = NAN; }},
      {"cameras[0] 'main': up", [](Scene& s) { s.cameras[0].target = s.cameras[0].position; }},
      {"cameras: a scene needs", [](Scene& s) { s.cameras.clear(); }},
      {"receivers[0] 'ground': is not flat", [](Scene& s) { s.receivers[0].corners[3].y = 1.0; }},
      {"receivers[0] 'ground': is not convex",
       [](Scene& s) { std::swap(s.receivers[0].corners[2], s.receivers[0].corners[3]); }},
      {"exposure", [](Scene& s) { s.exposure = 0.0f; }}};
  const Scene good = *scenes::load("contact");
  validate(good);
  for (const Fault& fault : faults) {
    Scene bad = good;
    fault.apply(bad);
    EXPECT_THAT(error_of([&] { validate(bad); }),
                HasSubstr(std::string("unreadable: ") + fault.named));
  }
}

TEST(FindCamera, TakesTheFirstForNoNameAndListsThoseThereAre) {
  const Scene scene = *scenes::load("leaky-box");
  EXPECT_EQ(find_camera(scene, ""), 0u);
  EXPECT_EQ(find_camera(scene, "outside"), 1u);
  EXPECT_THAT(error_of([&] { find_camera(scene, "roof"); }), HasSubstr("main, outside"));
}

TEST(WorldBounds, EncloseTransformedVertices) {
  Scene scene;
  scene.meshes.resize(1);
  scene.meshes[0].positions = {{0, 0, 0}, {1, 2, 3}};
  glm::dmat4 place(2.0);
  place[3] = {10, 0, 0, 1};
  scene.instances = {{"", 0, place, true}};
  const Bounds bounds = world_bounds(scene);
  EXPECT_EQ(bounds.low, glm::dvec3(10, 0, 0));
  EXPECT_EQ(bounds.high, glm::dvec3(12, 4, 6));
}

}  // namespace
}  // namespace penumbra
