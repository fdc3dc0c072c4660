// Scenes that reach far beyond what the camera sees: nothing near the camera changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace far_test {

using test::draw;
constexpr std::uint32_t width = 96;

Scene near_scene(LightKind kind) {
  scenes::SceneBuilder b("near", "A box over the ground");
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f));
  b.ground({-6.0, -6.0}, {6.0, 6.0}, grey);
  b.place(scenes::box({-0.5, 0.3, -0.5}, {0.5, 1.3, 0.5}), grey, "box");
  Light& lamp = b.spot("lamp", {-2.0, 4.0, 2.5}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 40.0, {});
  lamp.kind = kind;
  b.camera("main", {2.5, 3.0, 5.0}, {0.0, 0.5, 0.0}, 40.0);
  b.scene.cameras[0].near_plane = 0.05;
  return b.scene;
}

Scene with_moon(Scene scene, double distance) {
  Instance moon = scene.instances.back();
  moon.name = "moon";
  moon.world_from_object[3] = glm::dvec4(0.6 * distance, 0.6 * distance, -0.6 * distance, 1.0);
  scene.instances.push_back(moon);
  return scene;
}

/// One more triangle in the box's mesh, upright, from its top to a far point.
Scene with_stray(Scene scene, double distance) {
  Mesh& mesh = scene.meshes[scene.instances.back().mesh];
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::vec3 position : {glm::vec3(-0.01f, 1.0f, 0.0f), glm::vec3(0.01f, 1.0f, 0.0f),
                                   glm::vec3(0.0f, static_cast<float>(distance), 0.0f)}) {
    mesh.positions.push_back(position);
    mesh.normals.push_back({0.0f, 0.0f, 1.0f});
    if (!mesh.uvs.empty()) mesh.uvs.push_back({0.0f, 0.0f});
  }
  for (std::uint32_t k = 0; k < 3; ++k) mesh.indices.push_back(first + k);
  mesh.primitives.front().index_count += 3;
  return scene;
}

/// Share of the judged pixels that are wrong by exact rays.
double wrong_share(const Scene& scene, const std::string& technique, RenderResult* out = nullptr) {
  const RenderResult result = draw(scene, technique, {}, {}, width);
  const std::vector<int> truth = test::exact_visibility(scene, {}, width);
  std::size_t wrong = 0, judged = 0, dark = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] < 0 || result.judged.pixels[i] < 1.0f) continue;
    ++judged;
    dark += truth[i] == 0;
    wrong += std::abs(result.visibility.pixels[i] - static_cast<float>(truth[i])) > 0.5f;
  }
  EXPECT_GT(dark, judged / 50) << "a scene without shadows shows nothing";
  if (out != nullptr) *out = result;
  return static_cast<double>(wrong) / static_cast<double>(judged);
}

bool names_a_step(const std::vector<std::string>& notes) {
  return std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("in steps of") != std::string::npos;
  });
}

TEST(FarScenes, keep_the_shadows_near_the_camera) {
  for (const LightKind kind : {LightKind::spot, LightKind::point, LightKind::directional})
    for (const char* technique : {"ray-traced", "shadow-volumes", "shadow-map"}) {
      const Scene near = near_scene(kind);
      // What the technique's own resolution costs.
      const double own = wrong_share(near, technique);
      for (const double distance : {1e4, 1e6, 3.8e8, 1e9}) {
        RenderResult result;
        EXPECT_LE(wrong_share(with_moon(near, distance), technique, &result), own + 0.005)
            << technique << " light " << static_cast<int>(kind) << " moon at " << distance;
        EXPECT_TRUE(names_a_step(result.notes)) << distance;
      }
    }
}

TEST(FarScenes, bear_a_stray_vertex) {
  for (const char* technique : {"ray-traced", "shadow-volumes", "shadow-map", "pcf-3x3", "vsm"}) {
    const Scene near = near_scene(LightKind::spot);
    const double own = wrong_share(near, technique);
    for (const double distance : {1e4, 1e9}) {
      RenderResult result;
      EXPECT_LE(wrong_share(with_stray(near, distance), technique, &result), own + 0.01)
          << technique << " vertex at " << distance;
      EXPECT_TRUE(names_a_step(result.notes)) << distance;
    }
  }
}

TEST(FarScenes, of_ordinary_size_have_no_note) {
  EXPECT_FALSE(names_a_step(draw(near_scene(LightKind::spot), "none", {}, {}, 16).notes));
}

TEST(FarScenes, name_the_step_of_coordinates_that_are_too_coarse_for_their_mesh) {
  // A body of a metre, 2^22 m from its mesh's origin: floats there are half a metre apart.
  Scene scene = near_scene(LightKind::spot);
  for (glm::vec3& position : scene.meshes.back().positions) position.x += 4194304.0f;
  scene.instances.back().world_from_object[3].x = -4194304.0;
  const auto notes = draw(scene, "none", {}, {}, 16).notes;
  EXPECT_THAT(notes, testing::Contains(testing::HasSubstr("0.5 m")));
}

}  // namespace far_test
}  // namespace penumbra
