// Maps that are finer than the picture: which level of means a pixel reads, and what bounds by
// moments make of a plane that scatters in depth within it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "avenue.h"
#include "drawing.h"
#include "scenes.h"

namespace penumbra::tests {
namespace minification_test {

constexpr std::uint32_t picture = 128;  // pixels a side

/// Open ground under a sun 30 degrees high, as a person on it sees it: all of it is lit.
Scene open_ground() {
  Scene scene = plain({0, 1.7, 5}, {0, 1.2, -20});
  scene.lights.push_back(slanted_sun({0.5, -0.5, -0.7071}));
  return scene;
}

/// Level of a pixel of the diagnostic `mip-level`, 0 to 3: red to yellow, to green, to blue.
double level_of(const Image8& colors, std::uint32_t x, std::uint32_t y) {
  const double red = colors.at(x, y, 0) / 255.0, green = colors.at(x, y, 1) / 255.0;
  const double blue = colors.at(x, y, 2) / 255.0;
  if (red > 0.999) return green;
  if (blue > 0.001) return 2.0 + blue;
  return 2.0 - red;
}

Image8 levels(std::int64_t blur) {
  RenderRequest asked = request(
      std::make_shared<const Scene>(open_ground()), "vsm",
      {{"map_size", std::int64_t{512}}, {"blur", blur}, {"blur_filter", std::string("box")}},
      picture);
  asked.diagnostic = "mip-level";
  return renderer().render(asked).diagnostic;
}

TEST(MipLevel, is_what_the_blur_leaves_to_do) {
  // A square of w texels has a variance of w^2 / 12, a box blur one of ((2 r + 1)^2 - 1) / 12 less
  // a texel's own. What the level without blur tells is log2(w).
  const Image8 sharp = levels(0);
  std::size_t compared = 0;
  for (const std::int64_t blur : {1, 2}) {
    const double covered = std::pow(2.0 * static_cast<double>(blur) + 1.0, 2.0) - 1.0;
    const Image8 blurred = levels(blur);
    for (std::uint32_t y = picture / 2 + 2; y < picture; ++y)
      for (std::uint32_t x = 0; x < picture; ++x) {
        const double width = std::exp2(level_of(sharp, x, y));
        if (width > 7.9) continue;  // the colours end at 8
        const double expected = 0.5 * std::log2(std::max(width * width - covered, 1.0));
        // A step of the colours is a 255th of a level, and a view is wider by what is read beyond
        // its border, a hundredth; the difference of squares enlarges both.
        const double blurring = std::max(width * width - covered, 1.0);
        EXPECT_NEAR(level_of(blurred, x, y), expected, 0.02 + 0.015 * width * width / blurring)
            << x << ", " << y;
        ++compared;
      }
  }
  EXPECT_GT(compared, 2000u);
}

TEST(MipLevel, stays_at_the_finest_for_longer_the_wider_the_blur) {
  // Adorjan 2013, 3.3.3 and fig. 4.5: 1x1 and 7x7 texels.
  const auto share_of_finest = [](std::int64_t blur) {
    const Image8 colors = levels(blur);
    std::size_t finest = 0;
    for (std::uint32_t y = picture / 2; y < picture; ++y)
      for (std::uint32_t x = 0; x < picture; ++x) finest += level_of(colors, x, y) < 0.01;
    return static_cast<double>(finest) / (picture * picture / 2);
  };
  EXPECT_GT(share_of_finest(3), share_of_finest(0) + 0.1);
}

TEST(TexelsPerPixel, are_told_by_colour) {
  // A map of 8 texels has texels of a metre here (a quarter of its width is free on each side of 4
  // m), and the picture covers 4 m. Red, yellow, green, cyan and blue are 1/16, 1/4, 1, 4, 16.
  Scene scene = empty_scene(1.0, 8.0);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  scene.lights.push_back(sun());
  const auto color = [&](std::int64_t map_size, std::uint32_t size) {
    RenderRequest asked =
        request(std::make_shared<const Scene>(scene), "shadow-map", {{"map_size", map_size}}, size);
    asked.diagnostic = "texels-per-pixel";
    const Image8 drawn = renderer().render(asked).diagnostic;
    return std::array<int, 3>{drawn.at(size / 2, size / 2, 0), drawn.at(size / 2, size / 2, 1),
                              drawn.at(size / 2, size / 2, 2)};
  };
  EXPECT_EQ(color(4, 4), (std::array{0, 255, 0}));
  EXPECT_EQ(color(4, 16), (std::array{255, 255, 0}));
  EXPECT_EQ(color(4, 64), (std::array{255, 0, 0}));
  EXPECT_EQ(color(4, 1), (std::array{0, 255, 255}));
}

/// Least visibility of the open ground, and its mean.
std::pair<double, double> lit_ground(const std::string& technique, ParameterValues parameters) {
  const RenderResult result = draw(open_ground(), technique, parameters, picture);
  double least = 1.0, sum = 0.0, judged = 0.0;
  for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i) {
    if (result.judged.pixels[i] < 0.5f) continue;
    const double lit = double{result.visibility.pixels[i]};
    least = std::min(least, lit);
    sum += lit;
    judged += 1.0;
  }
  EXPECT_GT(judged, 4000.0);
  return {least, sum / judged};
}

TEST(MomentBounds, leave_open_ground_lit_however_flat_it_is_seen) {
  for (const char* technique : {"vsm", "evsm", "msm", "esm"})
    for (const std::int64_t blur : {0, 2, 7})
      for (const bool anisotropic : {false, true}) {
        SCOPED_TRACE(std::string(technique) + ", blur " + std::to_string(blur) +
                     (anisotropic ? ", anisotropic" : ""));
        const auto [least, mean] =
            lit_ground(technique, {{"blur", blur}, {"anisotropic", anisotropic}});
        EXPECT_GT(least, 0.97);
        EXPECT_GT(mean, 0.9995);
      }
}

TEST(MomentBounds, of_four_moments_need_to_know_the_receivers_plane) {
  // Of a stretch of even depths, seen from its middle, four moments allow as little as 5/18 before
  // it (the outer weight of Gauss and Legendre's rule of three points): light is 13/18, which
  // bleeding reduction stretches. A strategy that does not know the plane leaves that.
  const double reduction = 0.0, nearly_lit = 0.98;
  const auto [least, mean] = lit_ground("msm", {{"bias_strategy", std::string("constant")},
                                                {"slope_scale", 0.0},
                                                {"bleeding_reduction", reduction},
                                                {"blur", std::int64_t{0}}});
  EXPECT_NEAR(least, 13.0 / 18.0 / nearly_lit, 0.05);
  EXPECT_LT(mean, 0.995);
}

}  // namespace minification_test
}  // namespace penumbra::tests
