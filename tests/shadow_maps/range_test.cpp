// Where a map's range of depth lies. ESM tells it in closed form: c depths under a caster it leaves
// exp(-c) of the light.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "drawing.h"
#include "hard_truth.h"
#include "plates.h"
#include "scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace range_test {

constexpr std::uint32_t picture = 64;

/// Ground and on it a step of half a metre, wholly in the shadow of a plate 1 m up; the camera
/// looks from between them.
Scene shadowed_step() {
  Scene scene = plate_over_ground();
  add_box(scene, {-0.25, 0.001, -0.25}, {0.0, 0.5, 0.25});
  return scene;
}

/// Of the light on the step's top, and on the ground beside it.
struct Lit {
  double step;
  double ground;
};

Lit lit(const Scene& scene, const std::string& technique, ParameterValues parameters) {
  parameters["map_size"] = std::int64_t{256};
  const ImageF visibility = draw(scene, technique, parameters, picture).visibility;
  return {static_cast<double>(visibility.at(picture / 2 - 6, picture / 2, 0)),
          static_cast<double>(visibility.at(picture / 2 + 10, picture / 2, 0))};
}

ParameterValues exponential(const std::string& range) {
  return {{"range", range}, {"c", 2.0}, {"blur", std::int64_t{0}}, {"fallback", "none"}};
}

TEST(Ranges, of_boxes_run_from_the_nearest_caster_to_the_farthest_receiver) {
  const Lit light = lit(shadowed_step(), "esm", exponential("boxes"));
  EXPECT_NEAR(light.step, std::exp(-2.0 * 0.5), 2e-3);
  EXPECT_NEAR(light.ground, std::exp(-2.0), 2e-3);
}

TEST(Ranges, of_what_is_seen_clamp_casters_before_it) {
  // From the step's top to the ground: the plate is clamped to the top, and leaks light there.
  const Lit light = lit(shadowed_step(), "esm", exponential("visible"));
  EXPECT_GT(light.step, 0.6);
  // Wider by a sample's step, 0.03 m, at either end.
  EXPECT_NEAR(light.ground, std::exp(-2.0), 2e-2);
  // Comparisons lose nothing, in whatever way they are biased.
  for (const char* bias :
       {"constant", "slope", "normal-offset", "receiver-plane", "midpoint", "dual-depth", "auto"}) {
    const Lit compared =
        lit(shadowed_step(), "shadow-map", {{"range", "visible"}, {"bias_strategy", bias}});
    EXPECT_EQ(compared.step, 0.0) << bias;
    EXPECT_EQ(compared.ground, 0.0) << bias;
  }
}

TEST(Ranges, that_are_fixed_do_not_follow_what_is_seen) {
  // Something far below the ground: from the plate to it there are 4 m.
  Scene scene = shadowed_step();
  add_plate(scene, {-1, -1}, {1, 1}, -3.0);
  const Lit light = lit(scene, "esm", exponential("fixed"));
  EXPECT_NEAR(light.step, std::exp(-2.0 * 0.5 / 4.0), 2e-3);
  EXPECT_NEAR(light.ground, std::exp(-2.0 / 4.0), 2e-3);
}

TEST(Ranges, of_what_is_seen_keep_few_bits_for_it) {
  // A caster at the lamp uses up what 1/z in 16 bits has: a step is 0.5 m on the ground. Casters
  // before what is seen need none.
  constexpr std::uint32_t pixels = 128;
  Scene scene = empty_scene(2.0, 6.0);
  add_plate(scene, {-4, -4}, {4, 4}, 0.0);
  add_box(scene, {1.0, 0.001, -0.5}, {2.0, 1.0, 0.5});
  add_box(scene, {0.0002, 9.996, 0.0002}, {0.0004, 9.997, 0.0004});
  scene.lights.push_back(lamp({0, 10, 0}, 25));
  scene.lights[0].direction = glm::normalize(glm::dvec3(0.1, -1, 0.2));
  const ImageF truth = HardTruth(scene).visibility("", pixels, pixels);
  const auto error = [&](const std::string& range) {
    const RenderResult result = draw(scene, "shadow-map",
                                     {{"range", range},
                                      {"depth", "hyperbolic"},
                                      {"depth_bits", "16"},
                                      {"map_size", std::int64_t{1024}}},
                                     pixels);
    return visibility_error(result.visibility, truth, result.judged).rms;
  };
  EXPECT_LT(error("visible"), 0.5 * error("boxes"));
}

TEST(Ranges, of_what_is_seen_are_kept_from_penumbrae_that_need_blockers) {
  Scene scene = shadowed_step();
  scene.lights[0].extent = {.kind = ExtentKind::disc, .radius = 2.0};
  const RenderResult result = draw(scene, "pcss", {{"range", "visible"}}, picture);
  EXPECT_THAT(result.notes, testing::Contains(testing::HasSubstr("boxes is kept")));
  const RenderResult boxes = draw(scene, "pcss", {}, picture);
  EXPECT_TRUE(same(result.visibility, boxes.visibility));
}

TEST(Ranges, of_what_is_seen_serve_all_six_views_of_a_point_light) {
  Scene scene = empty_scene(3.0, 8.0);
  add_plate(scene, {-6, -6}, {6, 6}, 0.0);
  add_box(scene, {0.6, 0.001, -0.3}, {1.0, 0.6, 0.3});
  add_box(scene, {-0.3, 0.4, -1.2}, {0.3, 0.8, -0.8});
  Light light = lamp({0, 1, 0}, 45);
  light.kind = LightKind::point;
  scene.lights.push_back(light);
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  for (const char* range : {"boxes", "visible", "fixed"}) {
    const RenderResult result = draw(scene, "shadow-map", {{"range", range}}, picture);
    EXPECT_LT(visibility_error(result.visibility, truth, result.judged).rms, 0.12) << range;
  }
}

TEST(Ranges, of_boxes_are_each_face_s_own) {
  // Walls 2 m beside a point light, casters half way and nearer, and the ground 40 m below: the
  // face that looks at a wall has its depths from 1 m to the wall's back, unless the filter
  // averages them.
  Scene scene = empty_scene(50.0, 60.0);
  add_plate(scene, {-20, -20}, {20, 20}, -40.0);
  for (const double side : {-1.0, 1.0})
    for (const bool turned : {false, true}) {
      const auto box = [&](double from, double to, double up) {
        const double near = std::min(side * from, side * to),
                     far = std::max(side * from, side * to);
        if (turned)
          add_box(scene, {-0.2, up - 0.2, near}, {0.2, up + 0.2, far});
        else
          add_box(scene, {near, up - 0.2, -0.2}, {far, up + 0.2, 0.2});
      };
      box(2.0, 2.1, -1.0);
      box(1.5, 1.6, 0.0);
      box(1.0, 1.1, 0.6);
    }
  Light light = lamp({0, 0, 0}, 45);
  light.kind = LightKind::point;
  scene.lights.push_back(light);
  const auto middle = [&](const char* technique, const char* range) {
    RenderRequest asked = request(std::make_shared<const Scene>(scene), technique,
                                  {{"range", range}, {"map_size", std::int64_t{256}}}, picture);
    asked.diagnostic = "map";
    return static_cast<double>(renderer().render(asked).diagnostic.at(picture / 2, picture / 2, 0));
  };
  EXPECT_NEAR(middle("shadow-map", "boxes"), 255.0 * (1.5 - 1.0) / (2.1 - 1.0), 1.0);
  EXPECT_NEAR(middle("vsm", "boxes"), 255.0 * (1.5 - 1.0) / (40.0 - 1.0), 1.0);
  EXPECT_NEAR(middle("shadow-map", "fixed"), 255.0 * 1.5 / 40.0, 1.0);
}

TEST(Cascades, fitted_to_samples_leave_out_what_hides_behind_a_wall) {
  // A wall ends the view at 8 m; the ground's box reaches 120 m.
  Scene scene = empty_scene(2.0, 1.0);
  add_plate(scene, {-40, -120}, {40, 10}, 0.0);
  add_box(scene, {-20, 0.001, -4}, {20, 12, -3});
  for (const double x : {-2.0, -0.7, 0.6, 1.9}) add_box(scene, {x, 0.001, 0}, {x + 0.2, 1.5, 0.2});
  Camera& camera = scene.cameras[0];
  camera.position = {0, 2, 5};
  camera.target = {0, 1, -3};
  camera.up = {0, 1, 0};
  camera.projection = Projection::perspective;
  camera.vertical_fov = 50.0;
  Light light = sun();
  light.direction = glm::normalize(glm::dvec3(0.6, -1.0, -0.4));
  scene.lights.push_back(light);
  const ImageF truth = HardTruth(scene).visibility("", 128, 128);
  const auto error = [&](const std::string& layout) {
    const RenderResult result =
        draw(scene, "shadow-map", {{"layout", layout}, {"map_size", std::int64_t{128}}}, 128);
    return visibility_error(result.visibility, truth, result.judged).rms;
  };
  EXPECT_LT(error("cascaded-sdsm"), 0.7 * error("cascaded"));
}

}  // namespace range_test
}  // namespace penumbra::tests
