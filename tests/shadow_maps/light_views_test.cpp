// How lights see the scene: faces, ranges, holes, memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "hard_truth.h"
#include "renderer/shadow_maps/views/light_view.h"
#include "scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace {

Scene floor_and_ceiling() {
  Scene scene = empty_scene(4.0, 10.0);
  add_plate(scene, {-6, -6}, {6, 6}, 0.0);
  return scene;
}

TEST(LightViews, a_map_of_512_texels_costs_a_mebibyte_a_light) {
  Scene scene = floor_and_ceiling();
  scene.lights.push_back(lamp({0, 3, 0}, 40));
  const RenderResult one = draw(scene, "shadow-map");
  ASSERT_EQ(one.cost.technique_memory.size(), 1u);
  EXPECT_EQ(one.cost.technique_memory[0].name, "shadow map");
  EXPECT_EQ(one.cost.technique_memory[0].bytes, 1048576u);
  scene.lights.push_back(lamp({1, 3, 0}, 40));
  scene.lights[1].name = "second";
  EXPECT_EQ(draw(scene, "shadow-map").cost.technique_memory[0].bytes, 2097152u);
}

TEST(LightViews, six_faces_of_a_point_light_meet_without_seams) {
  Scene scene = floor_and_ceiling();
  Light light = lamp({0.1, 1.0, -0.2}, 45);
  light.kind = LightKind::point;
  scene.lights.push_back(light);
  for (const char* technique : {"shadow-map", "pcf-3x3", "pcf-bilinear-3x3"}) {
    const RenderResult result = draw(scene, technique, {}, 200);
    for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i) {
      if (result.judged.pixels[i] > 0.5f) {
        ASSERT_NEAR(result.visibility.pixels[i], 1.0f, 1e-5f) << technique << " at " << i;
      }
    }
  }
}

TEST(LightViews, a_point_light_casts_shadows_in_all_directions) {
  Scene scene = floor_and_ceiling();
  Light light = lamp({0.0, 1.0, 0.0}, 45);
  light.kind = LightKind::point;
  scene.lights.push_back(light);
  // Posts on the axes, on the diagonals where faces meet, and between.
  for (int i = 0; i < 16; ++i) {
    const double angle = i * 0.39269908;
    const glm::dvec3 at(1.5 * std::cos(angle), 0.0, 1.5 * std::sin(angle));
    add_box(scene, at + glm::dvec3(-0.08, 0.001, -0.08), at + glm::dvec3(0.08, 0.4, 0.08));
  }
  const ImageF truth = HardTruth(scene).visibility("", 200, 200);
  const RenderResult result = draw(scene, "shadow-map", {}, 200);
  const auto error = tests::visibility_error(result.visibility, truth, result.judged);
  EXPECT_LT(error.false_shadow, 0.01);
  EXPECT_LT(error.missing_shadow, 0.01);
}

TEST(LightViews, a_box_outside_is_held_by_the_narrowest_square_turned_along_its_edges) {
  const Bounds box{{-1, -1, -1}, {1, 1, 1}};
  const auto ahead = shadow_maps::view_of_box(box, {0, 0, 10});
  ASSERT_TRUE(ahead);
  EXPECT_DOUBLE_EQ(ahead->tangent, 1.0 / 9.0);  // of the nearer face's corners
  // Over an edge: its ends lie 1 m up and 10 sqrt(2) - sqrt(2) ahead, the sides' sqrt(2) across.
  const auto askew = shadow_maps::view_of_box(box, {10, 0, 10});
  ASSERT_TRUE(askew);
  EXPECT_NEAR(askew->tangent, 0.1, 1e-12);
  // A right angle is as wide as one of six views; nearer they are narrower.
  EXPECT_TRUE(shadow_maps::view_of_box(box, {0, 0, 2.001}));
  EXPECT_FALSE(shadow_maps::view_of_box(box, {0, 0, 1.999}));
  EXPECT_FALSE(shadow_maps::view_of_box(box, {0, 0, 0.5}));
  EXPECT_FALSE(shadow_maps::view_of_box({}, {0, 0, 10}));
}

TEST(LightViews, a_point_light_far_from_the_scene_has_one_view_of_it) {
  Scene scene = floor_and_ceiling();
  for (int i = 0; i < 5; ++i) add_box(scene, {i - 2.5, 0.001, -0.8}, {i - 2.1, 0.6 + 0.1 * i, 0.7});
  Light light = lamp({0.5, 1.0, 0.2}, 45);
  light.kind = LightKind::point;
  scene.lights.push_back(light);
  constexpr std::uint64_t map_bytes = 1048576;
  EXPECT_EQ(draw(scene, "shadow-map").cost.technique_memory[0].bytes, 6 * map_bytes);
  for (const double distance : {20.0, 300.0, 1e5}) {
    scene.lights[0].position = distance * glm::normalize(glm::dvec3(0.5, 1.0, 0.3));
    const ImageF truth = HardTruth(scene).visibility("", 200, 200);
    const RenderResult result = draw(scene, "shadow-map", {}, 200);
    EXPECT_EQ(result.cost.technique_memory[0].bytes, map_bytes) << distance;
    const auto error = tests::visibility_error(result.visibility, truth, result.judged);
    EXPECT_LT(error.false_shadow, 0.005) << distance;
    EXPECT_LT(error.missing_shadow, 0.005) << distance;
  }
}

TEST(LightViews, a_directional_light_shadows_along_its_direction) {
  Scene scene = floor_and_ceiling();
  add_box(scene, {-1, 0.5, -1}, {1, 1.5, 1});
  Light light = sun();
  light.direction = glm::normalize(glm::dvec3(0.6, -1.0, 0.3));
  scene.lights.push_back(light);
  const ImageF truth = HardTruth(scene).visibility("", 200, 200);
  const RenderResult result = draw(scene, "shadow-map", {}, 200);
  const auto error = tests::visibility_error(result.visibility, truth, result.judged);
  EXPECT_LT(error.false_shadow, 0.005);
  EXPECT_LT(error.missing_shadow, 0.005);
}

TEST(LightViews, holes_of_masked_casters_let_light_through) {
  // A plate whose left half is a hole.
  Scene scene = empty_scene(0.4, 1.0);
  add_plate(scene, {-4, -4}, {4, 4}, 0.0);
  add_plate(scene, {-1, -1}, {1, 1}, 0.5);
  Texture texture;
  texture.width = 2;
  texture.height = 1;
  texture.rgba = {255, 255, 255, 0, 255, 255, 255, 255};
  scene.textures.push_back(texture);
  Material masked = scene.materials[0];
  masked.texture = 0;
  masked.alpha_mode = AlphaMode::mask;
  scene.materials.push_back(masked);
  scene.meshes[1].primitives[0].material = 1;
  scene.lights.push_back(sun());
  for (const char* technique : {"shadow-map", "pcf-bilinear", "pcss", "vsm"}) {
    const RenderResult result = draw(scene, technique);
    EXPECT_GT(result.visibility.at(4, 32, 0), 0.95f) << technique;
    EXPECT_LT(result.visibility.at(60, 32, 0), 0.05f) << technique;
  }
}

TEST(LightViews, a_caster_before_the_near_plane_still_shadows) {
  // Half a millimetre below the lamp, nearer than any near plane that is worth its precision.
  Scene scene = floor_and_ceiling();
  scene.lights.push_back(lamp({0, 3, 0}, 40));
  add_plate(scene, {-0.2, -0.2}, {0.2, 0.2}, 2.9999);
  scene.cameras[0].position.y = 2.0;
  scene.cameras[0].orthographic_height = 3.0;
  const RenderResult result = draw(scene, "shadow-map");
  float brightest = 0.0f;
  for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i)
    if (result.judged.pixels[i] > 0.5f)
      brightest = std::max(brightest, result.visibility.pixels[i]);
  EXPECT_EQ(brightest, 0.0f);
}

TEST(LightViews, the_fitted_range_leaves_out_what_the_light_does_not_reach) {
  // A tower far outside the cone reaches behind the lamp; the map's range must not follow it. Near
  // is black on the diagnostic picture, far white: the plate 1 m below the lamp is the nearest.
  Scene scene = floor_and_ceiling();
  scene.lights.push_back(lamp({0, 3, 0}, 30));
  add_plate(scene, {-0.1, -0.1}, {0.1, 0.1}, 2.0);
  add_box(scene, {4.0, 0.0, -1.0}, {5.0, 9.0, 1.0});
  RenderRequest with_map = request(std::make_shared<const Scene>(scene), "shadow-map");
  with_map.diagnostic = "map";
  const Image8 map = renderer().render(with_map).diagnostic;
  EXPECT_LT(map.at(32, 32, 0), 4);
  EXPECT_GT(map.at(4, 32, 0), 250);
}

}  // namespace
}  // namespace penumbra::tests
