#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "tests/metrics/pictures.h"

namespace penumbra::metrics {
namespace {

// Expected values of pictures: expected_values.py, whole two-dimensional kernels.
TEST(Flip, AgreesWithItsPlainDefinition) {
  const Image8 picture = noise(48, 40, 1);
  EXPECT_NEAR(flip(picture, noise(48, 40, 2)), 0.454410115143579, 1e-9);
  EXPECT_NEAR(flip(faint(picture), picture), 0.14966418467881074, 1e-9);
  EXPECT_NEAR(flip(shadow(96, 64, 14, 27), shadow(96, 64, 20, 21)), 0.17526768773879256, 1e-9);
}

TEST(Flip, AgreesWithItsPlainDefinitionAtAnotherDistance) {
  EXPECT_NEAR(flip(shadow(96, 64, 14, 27), shadow(96, 64, 20, 21), 20.0), 0.15624919631044643,
              1e-9);
}

TEST(Flip, LooksFarEnoughAroundTheFewPixelsThatDiffer) {
  const Image8 picture = shadow(200, 150, 40, 60);
  EXPECT_NEAR(flip(patched(picture), picture), 0.0053251304192169484, 1e-9);
}

TEST(Flip, RepeatsTheBordersOfPicturesSmallerThanItsKernels) {
  EXPECT_NEAR(flip(noise(5, 3, 1), noise(5, 3, 2)), 0.45152896758448097, 1e-9);
}

// Constant pictures pass the filters unchanged and have no features, which leaves the colour term:
// with d = HyAB^0.7 and m = d(green, blue), 0.95 d / 0.4 m up to 0.4 m, then on to 1 at m.
TEST(Flip, OfConstantPicturesIsTheColorTerm) {
  const auto between = [](Rgb a, Rgb b) { return flip(constant(9, 8, a), constant(9, 8, b)); };
  EXPECT_NEAR(between({0, 0, 0}, {255, 255, 255}), 0.9673797621793769, 1e-9);
  EXPECT_NEAR(between({0, 255, 0}, {0, 0, 255}), 1.0, 1e-9);
  EXPECT_NEAR(between({128, 128, 128}, {131, 128, 128}), 0.053275779412146215, 1e-9);
  EXPECT_NEAR(between({255, 0, 0}, {0, 255, 255}), 0.9799065027249693, 1e-9);
  EXPECT_NEAR(between({10, 20, 30}, {200, 40, 60}), 0.9558025073521569, 1e-9);
}

// By hand: L* of black and white differ by 100 and have no colour, so HyAB is 100. Green and blue
// of sRGB have L*a*b* (87.737, -86.183, 83.180) and (32.297, 79.188, -107.860) in tables (D65);
// Hunt's adjustment scales a*, b* by L*/100, which puts HyAB at 203.2.
TEST(Flip, OfBlackAndWhiteFollowsFromTabulatedLab) {
  const double green_l = 87.737, green_a = -86.183, green_b = 83.180;
  const double blue_l = 32.297, blue_a = 79.188, blue_b = -107.860;
  const double farthest = green_l - blue_l +
                          std::hypot(0.01 * green_l * green_a - 0.01 * blue_l * blue_a,
                                     0.01 * green_l * green_b - 0.01 * blue_l * blue_b);
  const double most = std::pow(farthest, 0.7);
  const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - 0.4 * most) / (most - 0.4 * most);
  EXPECT_NEAR(flip(constant(4, 4, {0, 0, 0}), constant(4, 4, {255, 255, 255})), expected, 1e-4);
}

TEST(Flip, OfEqualPicturesIsZero) {
  EXPECT_EQ(flip(noise(30, 20, 1), noise(30, 20, 1)), 0.0);
  EXPECT_EQ(flip(constant(8, 8, {0, 0, 0}), constant(8, 8, {0, 0, 0})), 0.0);
  EXPECT_EQ(flip(constant(8, 8, {255, 255, 255}), constant(8, 8, {255, 255, 255})), 0.0);
  EXPECT_EQ(flip(constant(1, 1, {9, 9, 9}), constant(1, 1, {9, 9, 9})), 0.0);
}

TEST(Flip, DoesNotDependOnWhichPictureIsTheReference) {
  const Image8 a = shadow(60, 50, 10, 20);
  const Image8 b = shadow(60, 50, 14, 15);
  EXPECT_DOUBLE_EQ(flip(a, b), flip(b, a));
}

TEST(Flip, CommutesWithTurningBothPictures) {
  const auto turned = [](const Image8& picture) {
    Image8 out(picture.height, picture.width, 3);
    for (std::uint32_t y = 0; y < picture.height; ++y)
      for (std::uint32_t x = 0; x < picture.width; ++x)
        for (std::uint32_t c = 0; c < 3; ++c) out.at(y, x, c) = picture.at(x, y, c);
    return out;
  };
  const Image8 a = noise(37, 21, 1);
  const Image8 b = noise(37, 21, 2);
  EXPECT_NEAR(flip(a, b), flip(turned(a), turned(b)), 1e-12);
}

// An observer far away sees a fine checkerboard as grey: its mean in linear light, 188 encoded.
TEST(Flip, ForgivesWhatTheEyeCannotResolve) {
  Image8 checkers(64, 64, 3);
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 0; x < 64; ++x)
      for (std::uint32_t c = 0; c < 3; ++c) checkers.at(x, y, c) = (x + y) % 2 ? 255 : 0;
  const Image8 grey = constant(64, 64, {188, 188, 188});
  const double near = flip(checkers, grey, 10.0);
  const double far = flip(checkers, grey, 200.0);
  EXPECT_GT(near, 0.8);
  EXPECT_LT(far, 0.1);
}

TEST(Flip, StaysWithinItsRangeOnExtremePictures) {
  Image8 bars(40, 40, 3);
  for (std::uint32_t y = 0; y < 40; ++y)
    for (std::uint32_t x = 0; x < 40; ++x)
      for (std::uint32_t c = 0; c < 3; ++c) bars.at(x, y, c) = x % 8 < 4 ? 255 : 0;
  for (const double pixels_per_degree : {1.0, 67.0, 1000.0}) {
    const double error = flip(bars, constant(40, 40, {0, 0, 0}), pixels_per_degree);
    EXPECT_GT(error, 0.0) << pixels_per_degree;
    EXPECT_LE(error, 1.0) << pixels_per_degree;
  }
}

TEST(Flip, RefusesDistancesOutOfRange) {
  const Image8 picture = constant(4, 4, {0, 0, 0});
  EXPECT_THROW(flip(picture, picture, 0.0), Error);
  EXPECT_THROW(flip(picture, picture, 1001.0), Error);
  EXPECT_THROW(flip(picture, picture, std::numeric_limits<double>::quiet_NaN()), Error);
}

}  // namespace
}  // namespace penumbra::metrics
