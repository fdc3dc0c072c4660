#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "tests/metrics/pictures.h"

namespace penumbra::metrics {
namespace {

/// Floats of `channels` channels, as another library compares them.
OIIO::ImageBufAlgo::CompareResults compare_elsewhere(const std::vector<float>& a,
                                                     const std::vector<float>& b, int width,
                                                     int height, int channels) {
  const OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
  OIIO::ImageBuf buffer_a(spec);
  OIIO::ImageBuf buffer_b(spec);
  buffer_a.set_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, a.data());
  buffer_b.set_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, b.data());
  return OIIO::ImageBufAlgo::compare(buffer_a, buffer_b, 0.0f, 0.0f);
}

std::vector<float> luma_of(const Image8& picture) {
  std::vector<float> values;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x)
      values.push_back(static_cast<float>(
          0.299 * picture.at(x, y, 0) + 0.587 * picture.at(x, y, 1) + 0.114 * picture.at(x, y, 2)));
  return values;
}

std::vector<float> shares_of(const Image8& picture) {
  std::vector<float> values;
  for (const std::uint8_t value : picture.pixels)
    values.push_back(static_cast<float>(value) / 255.0f);
  return values;
}

TEST(RmsY, AgreesWithOpenImageIo) {
  const Image8 a = noise(53, 31, 1);
  const Image8 b = noise(53, 31, 2);
  const auto judge = compare_elsewhere(luma_of(a), luma_of(b), 53, 31, 1);
  EXPECT_NEAR(rms_y(a, b), judge.rms_error, 1e-4);
}

TEST(RmsY, WeighsComponentsByTheirLuma) {
  const Image8 black = constant(7, 5, {0, 0, 0});
  EXPECT_NEAR(rms_y(constant(7, 5, {255, 0, 0}), black), 76.245, 1e-12);
  EXPECT_NEAR(rms_y(constant(7, 5, {0, 255, 0}), black), 149.685, 1e-12);
  EXPECT_NEAR(rms_y(constant(7, 5, {0, 0, 255}), black), 29.07, 1e-12);
  EXPECT_DOUBLE_EQ(rms_y(constant(7, 5, {255, 255, 255}), black), 255.0);
}

TEST(RmsY, IsTheRootOfTheMeanNotOfTheSum) {
  Image8 picture = constant(10, 10, {40, 40, 40});
  const Image8 reference = picture;
  for (std::uint32_t c = 0; c < 3; ++c) picture.at(3, 4, c) = 90;
  EXPECT_DOUBLE_EQ(rms_y(picture, reference), 5.0);  // sqrt(50^2 / 100)
}

TEST(RmsY, OfEqualPicturesIsZero) {
  EXPECT_EQ(rms_y(noise(20, 20, 3), noise(20, 20, 3)), 0.0);
}

TEST(Psnr, AgreesWithOpenImageIo) {
  Image8 a = noise(53, 31, 1);
  const Image8 b = noise(53, 31, 2);
  a.at(0, 0, 0) = 255;  // OpenImageIO takes the largest value found for the peak
  const auto judge = compare_elsewhere(shares_of(a), shares_of(b), 53, 31, 3);
  EXPECT_NEAR(psnr(a, b), judge.PSNR, 1e-5);
}

TEST(Psnr, OfAConstantDifferenceHasAClosedForm) {
  const Image8 reference = constant(9, 9, {100, 100, 100});
  EXPECT_NEAR(psnr(constant(9, 9, {110, 110, 110}), reference), 20.0 * std::log10(25.5), 1e-12);
  // One component of three: a third of the mean square.
  EXPECT_NEAR(psnr(constant(9, 9, {100, 110, 100}), reference),
              20.0 * std::log10(25.5) + 10.0 * std::log10(3.0), 1e-12);
  EXPECT_NEAR(psnr(constant(9, 9, {0, 0, 0}), constant(9, 9, {255, 255, 255})), 0.0, 1e-12);
}

TEST(Psnr, OfEqualPicturesIsInfinite) {
  EXPECT_EQ(psnr(noise(9, 9, 1), noise(9, 9, 1)), std::numeric_limits<double>::infinity());
}

TEST(Comparisons, IgnoreAlpha) {
  const Image8 opaque = noise(30, 20, 1);
  Image8 with_alpha(30, 20, 4);
  for (std::uint32_t y = 0; y < 20; ++y)
    for (std::uint32_t x = 0; x < 30; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c) with_alpha.at(x, y, c) = opaque.at(x, y, c);
      with_alpha.at(x, y, 3) = static_cast<std::uint8_t>(x + y);
    }
  const Image8 other = noise(30, 20, 2);
  EXPECT_EQ(rms_y(with_alpha, other), rms_y(opaque, other));
  EXPECT_EQ(psnr(with_alpha, other), psnr(opaque, other));
  EXPECT_EQ(ssim(with_alpha, other), ssim(opaque, other));
  EXPECT_EQ(flip(with_alpha, other), flip(opaque, other));
  EXPECT_EQ(error_map(with_alpha, other).pixels, error_map(opaque, other).pixels);
}

TEST(Comparisons, RefusePicturesOfDifferentSizesAndNameBoth) {
  try {
    rms_y(noise(20, 12, 1), noise(20, 13, 1));
    FAIL() << "pictures of different sizes were compared";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "bad_value");
    EXPECT_EQ(error.field, "picture");
    EXPECT_STREQ(error.what(), "pictures to compare must have the same size, not 20x12 and 20x13");
  }
  EXPECT_THROW(psnr(noise(20, 12, 1), noise(12, 20, 1)), Error);
  EXPECT_THROW(ssim(noise(20, 12, 1), noise(12, 20, 1)), Error);
  EXPECT_THROW(flip(noise(20, 12, 1), noise(12, 20, 1)), Error);
  EXPECT_THROW(error_map(noise(20, 12, 1), noise(12, 20, 1)), Error);
}

TEST(Comparisons, RefuseEmptyAndGreyPictures) {
  EXPECT_THROW(rms_y(Image8{}, Image8{}), Error);
  EXPECT_THROW(flip(Image8(0, 5, 3), Image8(0, 5, 3)), Error);
  EXPECT_THROW(rms_y(Image8(5, 5, 1), Image8(5, 5, 1)), Error);
}

TEST(ErrorMap, IsWhiteWhereExactBlueWhereTooDarkRedWhereTooBright) {
  const Image8 reference = constant(3, 1, {100, 100, 100});
  Image8 picture = reference;
  for (std::uint32_t c = 0; c < 3; ++c) {
    picture.at(1, 0, c) = 36;   // 64 too dark: full scale
    picture.at(2, 0, c) = 132;  // 32 too bright: half of it
  }
  const Image8 map = error_map(picture, reference);
  EXPECT_EQ(map.channels, 4u);
  EXPECT_EQ(map.pixels, (std::vector<std::uint8_t>{255, 255, 255, 255,  //
                                                   0, 0, 255, 255,      //
                                                   255, 128, 128, 255}));
}

TEST(ErrorMap, SaturatesBeyondFullScale) {
  const Image8 map = error_map(constant(1, 1, {255, 255, 255}), constant(1, 1, {0, 0, 0}), 10.0);
  EXPECT_EQ(map.pixels, (std::vector<std::uint8_t>{255, 0, 0, 255}));
}

TEST(ErrorMap, RefusesAScaleThatIsNone) {
  const Image8 picture = constant(1, 1, {0, 0, 0});
  EXPECT_THROW(error_map(picture, picture, 0.0), Error);
  EXPECT_THROW(error_map(picture, picture, -1.0), Error);
  EXPECT_THROW(error_map(picture, picture, std::numeric_limits<double>::quiet_NaN()), Error);
}

}  // namespace
}  // namespace penumbra::metrics
