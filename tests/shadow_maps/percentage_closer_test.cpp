// Percentage-closer filtering against what can be counted by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "drawing.h"
#include "scenes.h"

namespace penumbra::tests {
namespace {

/// van Sambeek 2007, fig. 2.6: of 3x3 texels five hold depth 11 and four 53, and a receiver stands
/// at depth 22. The scene is 4 m wide; a map of 8 texels keeps a quarter of its width free on each
/// side, so that a texel is a metre and the middle of the map a corner of texels.
Scene figure_of_depths() {
  Scene scene = empty_scene(0.0, 0.5);
  scene.cameras[0].position = {0.5, -12.0, 0.5};
  scene.cameras[0].target = {0.5, -22.0, 0.5};
  add_plate(scene, {-2, -2}, {2, 2}, -53.0);
  add_plate(scene, {-2, -2}, {2, 2}, -22.0, false);
  for (const glm::dvec2 low : {glm::dvec2(-1, -1), {1, -1}, {0, 0}, {-1, 1}, {1, 1}})
    add_plate(scene, low, low + 1.0, -11.0);
  scene.lights.push_back(sun());
  return scene;
}

TEST(PercentageCloser, compares_first_and_filters_after) {
  const RenderResult nine = draw(figure_of_depths(), "pcf-3x3", {{"map_size", std::int64_t{8}}}, 8);
  EXPECT_THAT(nine.visibility.pixels, testing::Each(testing::FloatNear(4.0f / 9.0f, 1e-6f)));
  const RenderResult one =
      draw(figure_of_depths(), "shadow-map", {{"map_size", std::int64_t{8}}}, 8);
  EXPECT_THAT(one.visibility.pixels, testing::Each(0.0f)) << "the middle texel holds depth 11";
}

/// A straight edge that lies askew to the texels.
Scene askew_edge() {
  Scene scene = empty_scene(0.4, 1.0);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-2, -3}, {0, 3}, 0.5);
  const double angle = 0.35;
  scene.instances.back().world_from_object =
      glm::dmat4(std::cos(angle), 0, -std::sin(angle), 0, 0, 1, 0, 0, std::sin(angle), 0,
                 std::cos(angle), 0, 0, 0, 0, 1);
  scene.lights.push_back(lamp({0, 3, 0}, 35));
  return scene;
}

std::set<float> levels(const std::string& technique) {
  const RenderResult result = draw(askew_edge(), technique, {{"map_size", std::int64_t{128}}}, 200);
  return {result.visibility.pixels.begin(), result.visibility.pixels.end()};
}

TEST(PercentageCloser, four_comparisons_have_five_levels_and_nine_have_ten) {
  const auto shares = [](int count) {
    std::set<float> all;
    for (int i = 0; i <= count; ++i) all.insert(static_cast<float>(i) / static_cast<float>(count));
    return all;
  };
  EXPECT_EQ(levels("pcf-2x2"), shares(4));
  EXPECT_THAT(levels("pcf-3x3"), testing::SizeIs(10));
}

TEST(PercentageCloser, bilinear_comparisons_leave_no_bands) {
  EXPECT_GT(levels("pcf-bilinear").size(), 200u);
  EXPECT_GT(levels("pcf-bilinear-3x3").size(), 200u);
}

TEST(PercentageCloser, the_sampler_interpolates_as_the_shader_does) {
  const ParameterValues constant{{"bias_strategy", std::string("constant")}};
  const auto scene = scenes::load("disco-box");
  const RenderResult by_sampler = draw(scene, "pcf-hardware-bilinear", constant, 100);
  const RenderResult by_shader = draw(scene, "pcf-bilinear", constant, 100);
  float worst = 0.0f;
  for (std::size_t i = 0; i < by_shader.visibility.pixels.size(); ++i)
    worst =
        std::max(worst, std::abs(by_shader.visibility.pixels[i] - by_sampler.visibility.pixels[i]));
  EXPECT_LE(worst, 1.0f / 255.0f);
}

/// Half of the ground under a roof whose edge lies on the border between two texels, under a sun
/// overhead.
Scene edge_between_texels() {
  Scene scene = empty_scene(2.5, 0.5);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-2, -2}, {0, 2}, 3.0);
  scene.lights.push_back(sun());
  return scene;
}

TEST(PercentageCloser, reads_of_the_sampler_are_means_of_interpolated_comparisons) {
  // Across the edge a bilinear comparison is a ramp one texel wide; the mean of n of them, a texel
  // apart, is one that rises by 1/n over each of n texels: the 1D image of n x n reads.
  for (const int n : {1, 2, 3}) {
    const std::string preset =
        n == 1 ? "pcf-hardware-bilinear"
               : "pcf-hardware-bilinear-" + std::to_string(n) + "x" + std::to_string(n);
    constexpr std::uint32_t size = 64;
    // Of 64 texels n / 2 + 1 on each side are left free around the 4 m of the ground.
    const double texel = 4.0 / (62.0 - n);
    const RenderResult result =
        draw(edge_between_texels(), preset, {{"map_size", std::int64_t{64}}}, size);
    for (std::uint32_t x = 0; x < size; ++x) {
      const double place = (0.5 * (x + 0.5) / size - 0.25) / texel;  // texels from the edge
      double lit = 0.0;
      for (int i = 0; i < n; ++i) lit += std::clamp(place + i - 0.5 * (n - 1) + 0.5, 0.0, 1.0) / n;
      EXPECT_NEAR(result.visibility.at(x, size / 2, 0), lit, 1.5 / 256) << preset << ", " << place;
    }
  }
}

/// Share of the picture in which a straight border is neither lit nor dark.
double border_share(const ParameterValues& parameters) {
  const RenderResult result = draw(askew_edge(), "pcf", parameters, 200);
  const auto& pixels = result.visibility.pixels;
  return static_cast<double>(std::count_if(pixels.begin(), pixels.end(),
                                           [](float v) { return v > 0.001f && v < 0.999f; })) /
         static_cast<double>(pixels.size());
}

TEST(PercentageCloser, a_border_is_as_wide_as_the_kernel) {
  const double three = border_share({{"kernel", std::int64_t{3}}});
  const double eleven = border_share({{"kernel", std::int64_t{11}}});
  EXPECT_NEAR(eleven / three, 11.0 / 3.0, 0.3);
  // The edge lies 0.35 rad askew: a square is cos + sin wide across it and a disc 1. The disc's
  // taps are whole texels, which adds one.
  const double disc = border_share({{"kernel", std::int64_t{11}},
                                    {"filter", std::string("vogel")},
                                    {"taps", std::int64_t{128}}});
  EXPECT_NEAR(disc / eleven, 12.0 / (11.0 * (std::cos(0.35) + std::sin(0.35))), 0.08);
}

TEST(PercentageCloser, an_adaptive_kernel_widens_where_the_map_is_finer_than_the_picture) {
  // 8 texels a pixel: the kernel grows from one texel to as many.
  const auto blurred = [](bool adaptive) {
    const RenderResult result = draw(
        askew_edge(), "pcf",
        {{"kernel", std::int64_t{1}}, {"map_size", std::int64_t{2048}}, {"adaptive", adaptive}},
        64);
    const auto& pixels = result.visibility.pixels;
    return std::count_if(pixels.begin(), pixels.end(),
                         [](float v) { return v > 0.05f && v < 0.95f; });
  };
  EXPECT_GT(blurred(true), 2 * blurred(false));
}

}  // namespace
}  // namespace penumbra::tests
