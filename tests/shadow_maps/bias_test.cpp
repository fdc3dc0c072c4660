// Bias strategies against Embree: false shadow is acne, missing shadow is what bias takes away.
#include <gtest/gtest.h>

#include "drawing.h"
#include "hard_truth.h"
#include "renderer/metrics/metrics.h"
#include "scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace bias_test {

constexpr std::uint32_t size = 200;

metrics::VisibilityError error_of(const std::shared_ptr<const Scene>& scene,
                                  const std::string& technique,
                                  const ParameterValues& parameters = {}) {
  const ImageF truth = HardTruth(*scene).visibility("", size, size);
  const RenderResult result = draw(scene, technique, parameters, size);
  return tests::visibility_error(result.visibility, truth, result.judged);
}

class Bias : public testing::TestWithParam<const char*> {};

/// A map of 512 texels moves a shadow's border by half a texel to either side; acne would make the
/// picture darker on the whole.
TEST_P(Bias, needs_no_tuning) {
  const auto scene = scenes::load(GetParam());
  const ImageF truth = HardTruth(*scene).visibility("", size, size);
  for (const char* strategy : {"receiver-plane", "auto"}) {
    SCOPED_TRACE(strategy);
    const RenderResult result =
        draw(scene, "shadow-map", {{"bias_strategy", std::string(strategy)}}, size);
    const auto error = tests::visibility_error(result.visibility, truth, result.judged);
    EXPECT_GT(error.judged, 5000u);
    EXPECT_NEAR(error.bias, 0.0, 0.004);
    EXPECT_LT(error.false_shadow, 0.02);
    EXPECT_LT(error.missing_shadow, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Bias,
                         testing::Values("boxes", "car", "disco-box", "island", "warehouse-inside",
                                         "warehouse-outside", "contact", "three-layers"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

ParameterValues constant_bias(double metres) {
  return {{"bias_strategy", std::string("constant")}, {"slope_scale", 0.0}, {"bias", metres}};
}

TEST(BiasStrategies, too_little_constant_bias_is_acne_and_too_much_detaches_shadows) {
  const auto scene = scenes::load("boxes");
  const auto none = error_of(scene, "shadow-map", constant_bias(0.0));
  const auto some = error_of(scene, "shadow-map", constant_bias(0.3));
  const auto much = error_of(scene, "shadow-map", constant_bias(5.0));
  EXPECT_GT(none.false_shadow, 0.2);
  EXPECT_GT(none.false_shadow, some.false_shadow);
  EXPECT_GT(some.false_shadow, much.false_shadow);
  EXPECT_LT(none.missing_shadow, 0.01);
  EXPECT_GT(much.missing_shadow, 5.0 * some.missing_shadow);
  EXPECT_LT(some.rms, none.rms);
  EXPECT_LT(some.rms, much.rms);
}

TEST(BiasStrategies, back_faces_of_closed_meshes_need_no_bias) {
  const auto front = error_of(scenes::load("boxes"), "shadow-map", constant_bias(0.0));
  const auto back =
      error_of(scenes::load("boxes"), "shadow-map-back-faces", {{"slope_scale", 0.0}});
  EXPECT_LT(back.false_shadow, 0.02 * front.false_shadow);
}

TEST(BiasStrategies, slope_and_normal_offset_follow_the_slope_that_a_constant_cannot) {
  const auto scene = scenes::load("boxes");
  const auto constant = error_of(scene, "shadow-map", {{"bias_strategy", std::string("constant")}});
  const auto slope = error_of(scene, "shadow-map", {{"bias_strategy", std::string("slope")}});
  const auto offset =
      error_of(scene, "shadow-map", {{"bias_strategy", std::string("normal-offset")}});
  EXPECT_LT(slope.false_shadow, 0.5 * constant.false_shadow);
  EXPECT_LT(offset.false_shadow, 0.5 * constant.false_shadow);
  EXPECT_LT(offset.missing_shadow, 0.01);
}

TEST(BiasStrategies, bias_is_in_metres) {
  // A plate 0.3 m over the ground casts its shadow until the ground is granted 0.3 m.
  Scene scene = empty_scene(0.2, 0.5);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-1, -1}, {1, 1}, 0.3);
  scene.lights.push_back(lamp({0, 4, 0}, 30));
  EXPECT_EQ(draw(scene, "shadow-map", constant_bias(0.29)).visibility.at(32, 32, 0), 0.0f);
  EXPECT_EQ(draw(scene, "shadow-map", constant_bias(0.31)).visibility.at(32, 32, 0), 1.0f);
}

/// A receiver that casts nothing, at a height inside or below a box that reaches from 1 m to 2 m:
/// it is lit down to where the map has the box.
float lit_at(double height, const std::string& strategy) {
  Scene scene = empty_scene(height + 0.015, 0.5);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_box(scene, {-1, 1, -1}, {1, 2, 1});
  add_plate(scene, {-0.5, -0.5}, {0.5, 0.5}, height, false);
  scene.lights.push_back(sun());
  return draw(scene, "shadow-map", {{"bias_strategy", strategy}, {"map_size", std::int64_t{64}}}, 8)
      .visibility.at(4, 4, 0);
}

TEST(BiasStrategies, maps_of_two_surfaces_lie_where_they_say) {
  // A texel is 4 m / 62 = 0.0645 m wide.
  struct Case {
    const char* strategy;
    double below_top;  // m
  };
  for (const Case& expected : {Case{"second-depth", 1.0}, Case{"midpoint", 0.5},
                               Case{"dual-depth", 4.0 * 0.5 * 0.0645},  // slope 4 over half a texel
                               Case{"auto", 2.0 * 0.5 * 0.0645}}) {     // map and receiver
    SCOPED_TRACE(expected.strategy);
    EXPECT_EQ(lit_at(2.0 - expected.below_top + 0.02, expected.strategy), 1.0f);
    EXPECT_EQ(lit_at(2.0 - expected.below_top - 0.02, expected.strategy), 0.0f);
  }
}

TEST(BiasStrategies, a_bias_towards_the_second_surface_leaves_thin_casters_their_shadow) {
  // Two plates 2 mm apart, on texels of 65 mm, close over the ground.
  Scene scene = empty_scene(0.05, 0.5);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-1, -1}, {1, 1}, 0.100);
  add_plate(scene, {-1, -1}, {1, 1}, 0.102);
  add_plate(scene, {1.8, 1.8}, {2, 2}, 3.0);
  scene.lights.push_back(sun());
  const auto lit = [&](const char* strategy) {
    return draw(scene, "shadow-map",
                {{"bias_strategy", std::string(strategy)}, {"map_size", std::int64_t{64}}}, 8)
        .visibility.at(4, 4, 0);
  };
  EXPECT_EQ(lit("midpoint"), 0.0f);
  EXPECT_EQ(lit("dual-depth"), 0.0f);
  EXPECT_EQ(lit("auto"), 0.0f);
  EXPECT_EQ(lit("second-depth"), 0.0f);
}

TEST(BiasStrategies, the_second_surface_of_closed_meshes_needs_no_bias) {
  const auto scene = scenes::load("boxes");
  const auto front = error_of(scene, "shadow-map", constant_bias(0.0));
  for (const char* strategy : {"second-depth", "midpoint"}) {
    const auto error = error_of(scene, "shadow-map",
                                {{"bias_strategy", std::string(strategy)}, {"slope_scale", 0.0}});
    EXPECT_LT(error.false_shadow, 0.1 * front.false_shadow) << strategy;
    EXPECT_LT(error.missing_shadow, 0.01) << strategy;
  }
}

TEST(BiasStrategies, scale_does_not_matter) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    Scene scene = empty_scene(3.0 * scale, 2.0 * scale);
    add_box(scene, scale * glm::dvec3(-2, -0.2, -2), scale * glm::dvec3(2, 0, 2));
    add_box(scene, scale * glm::dvec3(-0.3, 0, -0.2), scale * glm::dvec3(0.3, 0.5, 0.2));
    scene.lights.push_back(lamp(scale * glm::dvec3(1.0, 3, 0.6), 40));
    const auto error = error_of(std::make_shared<const Scene>(scene), "shadow-map");
    EXPECT_LT(error.false_shadow, 0.01) << scale;
    EXPECT_LT(error.missing_shadow, 0.01) << scale;
  }
}

}  // namespace bias_test
}  // namespace penumbra::tests
