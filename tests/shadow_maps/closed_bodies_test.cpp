// Closed bodies are drawn into maps without their faces that are turned away from the light. Judged
// by Embree, which knows of no faces.
#include <gtest/gtest.h>

#include "drawing.h"
#include "hard_truth.h"
#include "scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace closed_bodies_test {

constexpr std::uint32_t size = 128;

Scene box_over_ground() {
  Scene scene = empty_scene(20.0, 12.0);
  add_plate(scene, {-6, -6}, {6, 6}, 0.0);
  add_box(scene, {-1.2, 0.5, -1.0}, {1.0, 2.0, 1.3});
  return scene;
}

Light slanted_sun() {
  Light light = sun();
  light.direction = glm::normalize(glm::dvec3(-1.0, -1.0, -0.3));
  return light;
}

Light lamp_beside() {
  return lamp({2.5, 6.0, 0.7}, 40.0);
}

/// Shares of judged samples that are wrong: a border of half a texel is.
void expect_true(const Scene& scene, const std::string& technique,
                 const ParameterValues& parameters) {
  const ImageF truth = HardTruth(scene).visibility("", size, size);
  const RenderResult result = draw(scene, technique, parameters, size);
  const auto error = tests::visibility_error(result.visibility, truth, result.judged);
  EXPECT_GT(error.judged, size * size / 4);
  EXPECT_LT(error.false_shadow, 0.005) << technique;
  EXPECT_LT(error.missing_shadow, 0.005) << technique;
}

TEST(BodiesInMaps, cast_the_shadows_that_all_their_faces_cast) {
  Scene scene = box_over_ground();
  scene.lights = {lamp_beside()};
  expect_true(scene, "shadow-map", {});
  expect_true(scene, "pcf", {{"kernel", std::int64_t{1}}});
  scene.lights = {slanted_sun()};
  for (const char* layout : {"single", "perspective", "trapezoidal", "iasm"}) {
    SCOPED_TRACE(layout);
    expect_true(scene, "shadow-map", {{"layout", std::string(layout)}});
  }
}

TEST(BodiesInMaps, that_are_open_cast_shadows_with_their_insides) {
  for (const Light& light : {slanted_sun(), lamp_beside()}) {
    Scene scene = box_over_ground();
    scene.lights = {light};
    // The upper side is the fourth: light falls in, and onto a wall from within.
    auto& indices = scene.meshes.back().indices;
    indices.erase(indices.begin() + 18, indices.begin() + 24);
    scene.meshes.back().primitives[0].index_count = 30;
    SCOPED_TRACE(light.name);
    expect_true(scene, "shadow-map", {});
  }
}

/// Nothing outside sees the light.
void expect_kept_in(const Scene& scene) {
  const RenderResult result = draw(scene, "shadow-map", {}, size);
  std::size_t judged = 0;
  for (std::size_t i = 0; i < result.judged.pixels.size(); ++i) {
    judged += result.judged.pixels[i] > 0.0f;
    ASSERT_EQ(result.judged.pixels[i] * result.visibility.pixels[i], 0.0f) << i;
  }
  EXPECT_GT(judged, 100u);
}

TEST(BodiesInMaps, around_the_light_keep_it_in) {
  Scene scene = box_over_ground();
  scene.lights = {lamp({0.0, 1.2, 0.0}, 60.0)};
  expect_kept_in(scene);
  // The side below the light is a material of its own: none is a body alone.
  scene.materials.push_back(scene.materials[0]);
  Mesh& box = scene.meshes.back();
  box.primitives = {{0, 12, 0}, {12, 6, 1}, {18, 18, 0}};
  expect_kept_in(scene);
}

TEST(BodiesInMaps, cast_shadows_of_lights_in_the_plane_of_a_face) {
  // As floats the upper side lies at 2.5999999.
  Scene scene = empty_scene(20.0, 12.0);
  add_plate(scene, {-6, -6}, {6, 6}, 0.0);
  add_box(scene, {-1.0, 1.0, -1.0}, {1.0, 2.6, 1.0});
  scene.lights = {lamp({0.3, 2.6, 0.2}, 60.0)};
  const RenderResult result = draw(scene, "shadow-map", {}, size);
  std::size_t dark = 0;
  for (std::size_t i = 0; i < result.judged.pixels.size(); ++i)
    dark += result.judged.pixels[i] > 0.0f && result.visibility.pixels[i] == 0.0f;
  EXPECT_GT(dark, 1000u) << "the underside hides the light from the ground";
}

}  // namespace closed_bodies_test
}  // namespace penumbra::tests
