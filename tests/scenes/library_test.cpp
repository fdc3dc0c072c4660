#include "scenes/library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "renderer/error.h"
#include "tests/scenes/watertight.h"

namespace penumbra::scenes {
namespace {

using testing::HasSubstr;

std::string message_of(const std::function<void()>& action, const std::string& code) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

std::size_t triangles_of(const Scene& scene) {
  std::size_t sum = 0;
  for (const Instance& instance : scene.instances)
    sum += scene.meshes[instance.mesh].indices.size() / 3;
  return sum;
}

/// Scenes that are about many triangles, and their bounds.
const std::map<std::string, std::size_t> large_scenes{{"trees", 160000}, {"town", 1100000}};

TEST(Library, LoadsEveryBuiltInSceneWithClosedCasters) {
  for (const SceneInfo& info : built_in()) {
    const auto scene = load(info.id);
    EXPECT_EQ(scene->id, info.id);
    EXPECT_EQ(scene->title, info.title);
    EXPECT_FALSE(scene->lights.empty()) << info.id;
    EXPECT_FALSE(scene->receivers.empty()) << info.id;
    const auto large = large_scenes.find(info.id);
    EXPECT_LT(triangles_of(*scene), large == large_scenes.end() ? 60000u : large->second)
        << info.id;
    std::set<std::uint32_t> drawn;
    for (const Instance& instance : scene->instances) drawn.insert(instance.mesh);
    for (const std::uint32_t number : drawn) {
      const Mesh& mesh = scene->meshes[number];
      EXPECT_EQ(test::leak_of(mesh), "") << info.id << ", " << mesh.name;
      EXPECT_GT(test::volume_of(mesh), 0.0) << info.id << ", " << mesh.name;
    }
  }
}

TEST(Library, HasTheSurveysSixScenesFirst) {
  std::vector<std::string> ids;
  for (const SceneInfo& info : built_in()) ids.push_back(info.id);
  ids.resize(6);
  EXPECT_THAT(ids, testing::ElementsAre("car", "boxes", "disco-box", "island", "warehouse-inside",
                                        "warehouse-outside"));
}

TEST(Library, SurveyScenesHaveTheObjectsAndLightsOfTheirDescription) {
  // van Sambeek 2007, 4.1.2
  EXPECT_EQ(load("car")->lights.size(), 2u);
  EXPECT_EQ(load("boxes")->instances.size(), 50u + 1u) << "50 boxes on a plane";
  const auto disco = load("disco-box");
  ASSERT_EQ(disco->lights.size(), 3u);
  for (int c = 0; c < 3; ++c) {
    const glm::vec3 color = disco->lights[static_cast<std::size_t>(c)].color;
    EXPECT_GT(color[c], 3.0f * std::max(color[(c + 1) % 3], color[(c + 2) % 3]));
  }
  for (const char* id : {"boxes", "island", "warehouse-inside", "warehouse-outside"})
    EXPECT_EQ(load(id)->lights.size(), 1u) << id;
  for (const char* id :
       {"car", "boxes", "disco-box", "island", "warehouse-inside", "warehouse-outside"})
    for (const Light& light : load(id)->lights)
      EXPECT_NE(light.extent.kind, ExtentKind::none) << id;
  // Light and camera of the outside view are closer to each other than to what they look at.
  const auto outside = load("warehouse-outside");
  const glm::dvec3 light = outside->lights[0].position, camera = outside->cameras[0].position;
  EXPECT_LT(glm::length(light - camera), std::min(glm::length(light), glm::length(camera)));
}

TEST(Library, ScenesForLayoutsHaveTheCastersOfTheirDescription) {
  // Alecu 2014, 4.1: several instances of one tree; one mesh for houses and yard.
  const auto trees = load("trees");
  std::map<std::string, int> copies;
  for (const Instance& instance : trees->instances) ++copies[trees->meshes[instance.mesh].name];
  EXPECT_EQ(copies["tree"], 60);
  EXPECT_EQ(load("village")->meshes.size(), 1u);
  EXPECT_EQ(load("village")->instances.size(), 1u);
  // Adorjan 2013, 4: approximately 10,800 triangles.
  EXPECT_NEAR(static_cast<double>(triangles_of(*load("tower"))), 10800.0, 100.0);
  EXPECT_NEAR(static_cast<double>(triangles_of(*load("town"))), 1e6, 2e4);
  for (const char* id : {"trees", "village", "tower", "town"}) {
    ASSERT_EQ(load(id)->lights.size(), 1u) << id;
    EXPECT_EQ(load(id)->lights[0].kind, LightKind::directional) << id;
  }
  // Sindholt 2005: a spot light, whose cone is what changes.
  EXPECT_EQ(load("water-tower")->lights[0].kind, LightKind::spot);
}

TEST(Library, ScenesOutOfDoorsStandOnTheirGround) {
  for (const char* id : {"trees", "village", "tower", "water-tower", "town"}) {
    const auto scene = load(id);
    Bounds receiver;
    for (const glm::dvec3& corner : scene->receivers[0].corners) receiver.add(corner);
    EXPECT_EQ(receiver.low.y, 0.0) << id;
    EXPECT_EQ(receiver.high.y, 0.0) << id;
    for (const Instance& instance : scene->instances) {
      const Bounds box = instance_bounds(*scene, instance);
      EXPECT_LE(box.low.y, 0.0) << id << ": " << instance.name << " hangs in the air";
      EXPECT_GE(box.high.y, 0.0) << id << ": " << instance.name << " is buried";
      EXPECT_GE(box.low.x, receiver.low.x) << id << ", " << instance.name;
      EXPECT_LE(box.high.x, receiver.high.x) << id << ", " << instance.name;
      EXPECT_GE(box.low.z, receiver.low.z) << id << ", " << instance.name;
      EXPECT_LE(box.high.z, receiver.high.z) << id << ", " << instance.name;
    }
  }
}

TEST(Fleet, HasTheAircraftOfItsName) {
  for (const int count : {1, 20, 400}) {
    const auto scene = load("fleet:" + std::to_string(count));
    EXPECT_EQ(scene->instances.size(), static_cast<std::size_t>(count) + 1);
    EXPECT_EQ(scene->id, "fleet:" + std::to_string(count));
    // On the apron, none in another: the jet's half length is 6.2 m before it is scaled.
    Bounds receiver;
    for (const glm::dvec3& corner : scene->receivers[0].corners) receiver.add(corner);
    for (std::size_t i = 1; i < scene->instances.size(); ++i) {
      const Bounds box = instance_bounds(*scene, scene->instances[i]);
      EXPECT_GE(box.low.x, receiver.low.x);
      EXPECT_LE(box.high.z, receiver.high.z);
    }
  }
  for (const char* name : {"fleet:", "fleet:0", "fleet:401", "fleet:5x2", "fleet:five", "fleet:5 "})
    EXPECT_THAT(message_of([&] { load(name); }, "bad_value"), HasSubstr("1..400")) << name;
}

TEST(Library, NamesTheScenesThereAreWhenOneIsUnknown) {
  const std::string message = message_of([] { load("boxen"); }, "not_found");
  EXPECT_THAT(message, HasSubstr("boxen"));
  EXPECT_THAT(message, HasSubstr("half-plane"));
  EXPECT_THAT(message, HasSubstr("sweep:OxTxL"));
  EXPECT_THAT(message, HasSubstr("fleet:N"));
}

TEST(ContentHash, IsTheSameForTwoLoadsAndDiffersBetweenScenes) {
  std::set<std::string> hashes;
  for (const SceneInfo& info : built_in()) {
    const std::string hash = content_hash(*load(info.id));
    EXPECT_EQ(hash.size(), 32u);
    EXPECT_TRUE(hashes.insert(hash).second) << info.id;
  }
  for (const char* id : {"boxes", "sweep:5x100x2"})
    EXPECT_EQ(content_hash(*load(id)), content_hash(*load(id))) << id;
}

TEST(ContentHash, ChangesWithEveryPartOfAPictureAndWithNothingElse) {
  const Scene scene = *load("contact");
  const std::string before = content_hash(scene);
  const std::vector<std::function<void(Scene&)>> seen = {
      [](Scene& s) { s.textures[0].rgba[5] ^= 1; },
      [](Scene& s) { s.materials[0].base_color.y *= 0.5f; },
      [](Scene& s) { s.materials[0].emissive.x = 1.0f; },
      [](Scene& s) { s.materials[0].alpha = 0.5f; },
      [](Scene& s) { s.materials[0].specular = 0.5f; },
      [](Scene& s) { s.materials[0].shininess = 5.0f; },
      [](Scene& s) { s.materials[0].texture = -1; },
      [](Scene& s) { s.materials[0].alpha_mode = AlphaMode::mask; },
      [](Scene& s) { s.materials[0].alpha_cutoff = 0.25f; },
      [](Scene& s) { s.materials[0].double_sided = true; },
      [](Scene& s) { s.meshes[0].positions[0].x += 1e-5f; },
      [](Scene& s) { s.meshes[0].normals[0] = -s.meshes[0].normals[0]; },
      [](Scene& s) { s.meshes[0].uvs[0].x += 0.5f; },
      [](Scene& s) { s.meshes[0].colors.resize(s.meshes[0].positions.size()); },
      [](Scene& s) { std::swap(s.meshes[0].indices[0], s.meshes[0].indices[1]); },
      [](Scene& s) { s.meshes[0].primitives[0].material = 1; },
      [](Scene& s) { s.instances[0].world_from_object[3].x += 1e-9; },
      [](Scene& s) { s.instances[0].casts_shadow = false; },
      [](Scene& s) { s.lights[0].name = "other"; },
      [](Scene& s) { s.lights[0].kind = LightKind::point; },
      [](Scene& s) { s.lights[0].position.z += 0.1; },
      [](Scene& s) { s.lights[0].direction.z += 0.1; },
      [](Scene& s) { s.lights[0].up.z += 0.1; },
      [](Scene& s) { s.lights[0].color.z += 0.1f; },
      [](Scene& s) { s.lights[0].intensity += 0.1f; },
      [](Scene& s) { s.lights[0].attenuation = Attenuation::inverse_square; },
      [](Scene& s) { s.lights[0].inner_angle -= 0.1; },
      [](Scene& s) { s.lights[0].outer_angle += 0.1; },
      [](Scene& s) { s.lights[0].range = 9.0; },
      [](Scene& s) { s.lights[0].extent.kind = ExtentKind::sphere; },
      [](Scene& s) { s.lights[0].extent.radius += 0.1; },
      [](Scene& s) { s.lights[0].extent.size.y += 0.1; },
      [](Scene& s) { s.cameras[0].name = "other"; },
      [](Scene& s) { s.cameras[0].position.x += 0.1; },
      [](Scene& s) { s.cameras[0].target.x += 0.1; },
      [](Scene& s) { s.cameras[0].up.x += 0.1; },
      [](Scene& s) { s.cameras[0].projection = Projection::orthographic; },
      [](Scene& s) { s.cameras[0].vertical_fov += 0.1; },
      [](Scene& s) { s.cameras[0].orthographic_height += 0.1; },
      [](Scene& s) { s.cameras[0].near_plane += 0.1; },
      [](Scene& s) { s.receivers[0].corners[0].x += 0.1; },
      [](Scene& s) { s.ambient.x += 0.1f; },
      [](Scene& s) { s.background_low.x += 0.1f; },
      [](Scene& s) { s.background_high.x += 0.1f; },
      [](Scene& s) { s.exposure += 0.1f; }};
  std::set<std::string> hashes = {before};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    Scene changed = scene;
    seen[i](changed);
    EXPECT_TRUE(hashes.insert(content_hash(changed)).second) << "change " << i;
  }
  Scene renamed = scene;
  renamed.id = renamed.title = "other";
  renamed.meshes[0].name = renamed.materials[0].name = renamed.instances[0].name = "other";
  renamed.notes = {"a note"};
  EXPECT_EQ(content_hash(renamed), before);
}

TEST(Sweep, HasTheObjectsTrianglesAndLightsOfItsName) {
  for (const int objects : {1, 200})
    for (const int triangles : {100, 1600, 10000})
      for (const int lights : {objects == 1 ? 1 : 3}) {
        const std::string name = "sweep:" + std::to_string(objects) + "x" +
                                 std::to_string(triangles) + "x" + std::to_string(lights);
        const auto scene = load(name);
        ASSERT_EQ(scene->instances.size(), static_cast<std::size_t>(objects) + 1) << name;
        EXPECT_EQ(scene->lights.size(), static_cast<std::size_t>(lights)) << name;
        const Mesh& knot = scene->meshes[scene->instances.back().mesh];
        EXPECT_NEAR(static_cast<double>(knot.indices.size()) / 3, triangles, 0.03 * triangles);
        EXPECT_EQ(test::leak_of(knot), "") << name;
        EXPECT_GT(test::volume_of(knot), 0.0) << name;
      }
}

TEST(Sweep, StandsOnItsGround) {
  const auto scene = load("sweep:100x1600x1");
  for (std::size_t i = 1; i < scene->instances.size(); ++i) {
    Scene one = *scene;
    one.instances = {scene->instances[i]};
    EXPECT_GE(world_bounds(one).low.y, 0.0);
    EXPECT_LE(world_bounds(one).low.y, 0.4);
  }
}

TEST(Sweep, RefusesNamesOutsideItsRangesAndSaysWhatTheyAre) {
  for (const char* name : {"sweep:", "sweep:5", "sweep:5x100", "sweep:0x100x1", "sweep:5x100x9",
                           "sweep:5x100x1x1", "sweep:5x100x", "sweep:-5x100x1", "sweep:5x10x1",
                           "sweep:99999999999x100x1", "sweep:5x100x1 "})
    EXPECT_THAT(message_of([&] { load(name); }, "bad_value"), HasSubstr("1..1000")) << name;
}

}  // namespace
}  // namespace penumbra::scenes
