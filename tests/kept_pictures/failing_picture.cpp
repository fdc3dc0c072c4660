// Expectations that fail, for tests/pictures to look at what they leave. Not run by ctest.
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace {

/// Grey of 4 x 2 pixels whose pixel (1, 0) has another level.
Image8 grey(std::uint8_t level) {
  Image8 picture(4, 2, 4, 100);
  for (std::size_t i = 3; i < picture.pixels.size(); i += 4) picture.pixels[i] = 255;
  for (std::uint32_t c = 0; c < 3; ++c) picture.at(1, 0, c) = level;
  return picture;
}

TEST(Fails, in_one_pixel) {
  EXPECT_TRUE(same(grey(180), grey(100)));
}

TEST(Fails, in_two_expectations_of_one_comparison) {
  const double error = rms_y(grey(180), grey(100));
  EXPECT_LT(error, 1.0);
  EXPECT_LT(error, 2.0);
}

TEST(Fails, in_visibility) {
  const ImageF lit(2, 2, 1, 1.0f);
  const ImageF dark(2, 2, 1, 0.0f);
  EXPECT_LT(visibility_error(dark, lit, ImageF(2, 2, 1, 1.0f)).rms, 0.5);
}

TEST(Fails, without_a_picture) {
  EXPECT_TRUE(false);
}

TEST(Succeeds, without_leaving_anything) {
  EXPECT_TRUE(same(grey(180), grey(180)));
}

}  // namespace
}  // namespace penumbra::tests
