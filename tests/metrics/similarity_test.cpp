#include <gtest/gtest.h>

#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "tests/metrics/pictures.h"

namespace penumbra::metrics {
namespace {

// scikit-image 0.19.3, by expected_values.py.
TEST(Ssim, AgreesWithScikitImage) {
  const Image8 picture = noise(48, 40, 1);
  EXPECT_NEAR(ssim(picture, noise(48, 40, 2)), 0.06788296517039294, 1e-12);
  EXPECT_NEAR(ssim(faint(picture), picture), 0.9912152575081414, 1e-12);
  EXPECT_NEAR(ssim(shadow(96, 64, 14, 27), shadow(96, 64, 20, 21)), 0.7195566856009842, 1e-12);
}

TEST(Ssim, OfConstantPicturesIsTheLuminanceTerm) {
  for (const auto& [a, b] : {std::pair{0, 255}, std::pair{17, 90}, std::pair{200, 201}}) {
    const auto level_a = static_cast<std::uint8_t>(a);
    const auto level_b = static_cast<std::uint8_t>(b);
    const double c1 = 2.55 * 2.55;
    const double expected = (2.0 * a * b + c1) / (1.0 * a * a + 1.0 * b * b + c1);
    EXPECT_NEAR(ssim(constant(13, 12, {level_a, level_a, level_a}),
                     constant(13, 12, {level_b, level_b, level_b})),
                expected, 1e-9)
        << a << " against " << b;
  }
}

TEST(Ssim, OfEqualPicturesIsOne) {
  EXPECT_NEAR(ssim(noise(20, 20, 1), noise(20, 20, 1)), 1.0, 1e-12);
  EXPECT_NEAR(ssim(constant(11, 11, {0, 0, 0}), constant(11, 11, {0, 0, 0})), 1.0, 1e-12);
  EXPECT_NEAR(ssim(constant(11, 11, {255, 255, 255}), constant(11, 11, {255, 255, 255})), 1.0,
              1e-9);
}

TEST(Ssim, OfASinglePatchWeighsTheMiddleMost) {
  const Image8 reference = constant(11, 11, {128, 128, 128});
  Image8 in_the_middle = reference;
  Image8 in_the_corner = reference;
  for (std::uint32_t c = 0; c < 3; ++c) {
    in_the_middle.at(5, 5, c) = 255;
    in_the_corner.at(0, 0, c) = 255;
  }
  EXPECT_LT(ssim(in_the_middle, reference), ssim(in_the_corner, reference));
}

TEST(Ssim, RefusesPicturesSmallerThanItsWindow) {
  EXPECT_THROW(ssim(noise(10, 40, 1), noise(10, 40, 2)), Error);
  EXPECT_THROW(ssim(noise(40, 10, 1), noise(40, 10, 2)), Error);
}

}  // namespace
}  // namespace penumbra::metrics
