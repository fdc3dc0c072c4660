// PCSS and variance shadow maps against closed forms and against percentage-closer filtering.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "hard_truth.h"
#include "scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace {

constexpr double lamp_height = 4.0;

/// A plate whose edge runs over x = 0 at height h, under a square light of 1 m at 4 m.
Scene edge_at(double h, double light_width = 1.0) {
  Scene scene = empty_scene(0.8 * h, 1.0);
  add_plate(scene, {-3, -3}, {3, 3}, 0.0);
  add_plate(scene, {-2, -3}, {0, 3}, h);
  Light light = lamp({0, lamp_height, 0}, 40);
  light.extent.kind = ExtentKind::rectangle;
  light.extent.size = {light_width, light_width};
  scene.lights.push_back(light);
  return scene;
}

/// Widths over which the middle row rises from a tenth to nine tenths, as a full ramp's width in m.
double penumbra_width(const RenderResult& result) {
  const std::uint32_t width = result.visibility.width;
  std::vector<double> profile(width, 0.0);
  for (std::uint32_t y = 0; y < result.visibility.height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      profile[x] += static_cast<double>(result.visibility.at(x, y, 0)) / result.visibility.height;
  const auto crossing = [&](double level) {
    for (std::uint32_t x = 1; x < width; ++x)
      if (profile[x - 1] < level && profile[x] >= level)
        return x - 1 + (level - profile[x - 1]) / (profile[x] - profile[x - 1]);
    return -1.0;
  };
  return (crossing(0.9) - crossing(0.1)) / 0.8 / width;
}

class Penumbra : public testing::TestWithParam<const char*> {};

TEST_P(Penumbra, is_as_wide_as_receiver_blocker_and_light_make_it) {
  // (d_receiver - d_blocker) w_light / d_blocker, van Sambeek 2007, 2.2.5.
  for (const double h : {0.5, 1.0, 1.5}) {
    const double expected = h * 1.0 / (lamp_height - h);
    EXPECT_NEAR(penumbra_width(draw(edge_at(h), GetParam(), {}, 100)), expected, 0.15 * expected)
        << "edge at " << h << " m";
  }
  const double half = 1.0 * 0.5 / (lamp_height - 1.0);
  EXPECT_NEAR(penumbra_width(draw(edge_at(1.0, 0.5), GetParam(), {}, 100)), half, 0.15 * half);
}

INSTANTIATE_TEST_SUITE_P(Blockers, Penumbra, testing::Values("pcss", "pcss-nearest"),
                         [](const auto& instance) {
                           return std::string(instance.param) == "pcss" ? "average" : "nearest";
                         });

TEST(SoftShadows, are_as_wide_where_the_map_keeps_1_z) {
  const double expected = 1.0 / (lamp_height - 1.0);
  const ParameterValues parameters{{"depth", std::string("hyperbolic")}, {"near", 0.1}};
  EXPECT_NEAR(penumbra_width(draw(edge_at(1.0), "pcss", parameters, 100)), expected,
              0.15 * expected);
}

TEST(SoftShadows, a_light_without_extent_casts_the_filters_own_border) {
  Scene scene = edge_at(1.0);
  scene.lights[0].extent = {};
  EXPECT_TRUE(tests::same(draw(scene, "pcss").visibility, draw(scene, "pcf-bilinear").visibility));
}

/// Ground under a square light of 1 m that stands upright, its middle 0.25 m over the ground's
/// plane.
Scene half_risen_light() {
  Scene scene = empty_scene(2.0, 1.0);
  add_plate(scene, {-3, -3}, {3, 3}, 0.0);
  Light light = lamp({-4, 0.25, 0}, 40);
  light.direction = {1, 0, 0};
  light.extent.kind = ExtentKind::rectangle;
  light.extent.size = {1.0, 1.0};
  scene.lights.push_back(light);
  return scene;
}

TEST(SoftShadows, light_behind_the_receivers_plane_does_not_count) {
  EXPECT_THAT(draw(half_risen_light(), "pcss").visibility.pixels,
              testing::Each(testing::FloatNear(0.75f, 0.02f)));
  EXPECT_THAT(draw(half_risen_light(), "pcss", {{"horizon", false}}).visibility.pixels,
              testing::Each(1.0f));
}

/// A sun of 20 x 20 degrees that shines `elevation` degrees over the horizon.
Light wide_sun(double elevation) {
  Light light = sun();
  const double angle = glm::radians(elevation);
  light.direction = {std::cos(angle), -std::sin(angle), 0};
  light.extent.kind = ExtentKind::rectangle;
  light.extent.size = {20.0, 20.0};
  return light;
}

TEST(SoftShadows, of_a_sun_are_as_wide_as_its_angle_makes_them) {
  Scene scene = edge_at(1.0);
  scene.lights[0] = wide_sun(90.0);
  const double expected = 2.0 * std::tan(glm::radians(10.0));
  EXPECT_NEAR(penumbra_width(draw(scene, "pcss", {}, 100)), expected, 0.15 * expected);
}

TEST(SoftShadows, a_sun_on_the_horizon_shines_by_the_share_that_has_risen) {
  Scene scene = half_risen_light();
  scene.lights[0] = wide_sun(5.0);
  const double half = std::tan(glm::radians(10.0));
  const auto share = static_cast<float>((std::tan(glm::radians(5.0)) + half) / (2.0 * half));
  EXPECT_THAT(draw(scene, "pcss").visibility.pixels,
              testing::Each(testing::FloatNear(share, 0.02f)));
}

TEST(SoftShadows, where_nothing_blocks_nothing_is_filtered) {
  Scene scene = edge_at(1.0);
  scene.cameras[0].position.x = scene.cameras[0].target.x = 1.6;
  EXPECT_THAT(draw(scene, "pcss").visibility.pixels, testing::Each(1.0f));
}

/// Two layers in parallel planes seen straight from the light: its map holds two depths only.
TEST(Variance, equals_percentage_closer_for_parallel_caster_and_receiver) {
  Scene scene = edge_at(1.0);
  for (const int radius : {1, 3, 6}) {
    const RenderResult variance = draw(scene, "vsm",
                                       {{"blur", std::int64_t{radius}},
                                        {"blur_filter", std::string("box")},
                                        {"mips", false},
                                        {"bleeding_reduction", 0.0},
                                        {"minimum_deviation", 0.0},
                                        {"slope_scale", 0.0},
                                        {"bias", 0.001}},
                                       100);
    const RenderResult counted =
        draw(scene, "pcf", {{"kernel", std::int64_t{2 * radius + 1}}}, 100);
    const auto error =
        tests::visibility_error(variance.visibility, counted.visibility, counted.judged);
    EXPECT_LT(error.rms, 0.01) << radius;
  }
}

/// Without mips, whose levels make up what a blur leaves.
double bleeding(std::int64_t blur, double reduction) {
  static const auto scene = scenes::load("three-layers");
  static const ImageF truth = HardTruth(*scene).visibility("", 150, 150);
  const RenderResult result =
      draw(scene, "vsm", {{"blur", blur}, {"bleeding_reduction", reduction}, {"mips", false}}, 150);
  return tests::visibility_error(result.visibility, truth, result.judged).missing_shadow;
}

TEST(Variance, bleeds_more_with_wider_blurs_and_less_with_reduction) {
  EXPECT_GT(bleeding(8, 0.0), bleeding(3, 0.0));
  EXPECT_GT(bleeding(3, 0.0), bleeding(0, 0.0));
  EXPECT_LT(bleeding(8, 0.3), bleeding(8, 0.0));
  EXPECT_LT(bleeding(8, 0.6), bleeding(8, 0.3));
}

TEST(Variance, reduction_darkens_penumbrae) {
  const auto mean = [](double reduction) {
    const RenderResult result =
        draw(edge_at(1.0), "vsm", {{"blur", std::int64_t{6}}, {"bleeding_reduction", reduction}});
    double sum = 0.0;
    for (const float v : result.visibility.pixels) sum += static_cast<double>(v);
    return sum;
  };
  EXPECT_LT(mean(0.6), mean(0.3));
  EXPECT_LT(mean(0.3), mean(0.0));
}

TEST(Variance, casters_of_few_texels_cast_pale_shadows) {
  // Rods 2, 4 and 16 texels wide, 0.5 m over the ground.
  float before = 1.1f;
  for (const double texels : {2.0, 4.0, 16.0}) {
    Scene scene = empty_scene(0.3, 0.6);
    add_plate(scene, {-2, -2}, {2, 2}, 0.0);
    const double half = 0.5 * texels * 2.0 * 3.5 * std::tan(0.698) / 512.0;
    add_plate(scene, {-half, -2}, {half, 2}, 0.5);
    scene.lights.push_back(lamp({0, 4, 0}, 40));
    const RenderResult result =
        draw(scene, "vsm", {{"blur", std::int64_t{3}}, {"bleeding_reduction", 0.0}});
    const float darkest =
        *std::min_element(result.visibility.pixels.begin(), result.visibility.pixels.end());
    EXPECT_LT(darkest, before - 0.05f) << texels << " texels";
    before = darkest;
  }
}

/// A comb of bars over a plane that recedes from the camera: far away a pixel covers many bars.
TEST(Variance, mips_cure_minification) {
  Scene scene = empty_scene(1.0, 1.0);
  scene.cameras[0].projection = Projection::perspective;
  scene.cameras[0].position = {0, 1.0, 3.9};
  scene.cameras[0].target = {0, 0.35, 0};
  scene.cameras[0].up = {0, 1, 0};
  scene.cameras[0].vertical_fov = 30;
  add_plate(scene, {-4, -4}, {4, 4}, 0.0);
  for (int i = -40; i < 40; ++i) add_plate(scene, {-4, 0.1 * i}, {4, 0.1 * i + 0.05}, 1.5);
  scene.lights.push_back(sun());
  auto shared = std::make_shared<const Scene>(scene);
  // Half of the light is held back; the map resolves every bar, the picture does not.
  const auto noise = [&](bool mips) {
    const RenderResult result = draw(shared, "vsm",
                                     {{"map_size", std::int64_t{2048}},
                                      {"blur", std::int64_t{0}},
                                      {"bleeding_reduction", 0.0},
                                      {"mips", mips}},
                                     100);
    double sum = 0.0;
    int count = 0;
    for (std::uint32_t y = 0; y < 100; ++y)
      for (std::uint32_t x = 0; x < 100; ++x) {
        if (result.judged.at(x, y, 0) < 0.5f || y > 60) continue;
        const double away = static_cast<double>(result.visibility.at(x, y, 0)) - 0.5;
        sum += away * away;
        ++count;
      }
    EXPECT_GT(count, 300);
    return std::sqrt(sum / count);
  };
  EXPECT_LT(noise(true), 0.6 * noise(false));
}

TEST(Variance, sixteen_bits_take_half_the_memory) {
  const auto bytes = [](const char* precision) {
    double sum = 0.0;
    const RenderResult result =
        draw(edge_at(1.0), "vsm", {{"precision", std::string(precision)}}, 16);
    for (const ResourceCost& resource : result.cost.technique_memory)
      if (resource.name.find("blurred") == 0) sum += static_cast<double>(resource.bytes);
    return sum;
  };
  // Allocations are rounded up a little.
  EXPECT_NEAR(bytes("fp32") / bytes("fp16"), 2.0, 0.01);
}

}  // namespace
}  // namespace penumbra::tests
