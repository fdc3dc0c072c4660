#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "renderer/error.h"
#include "renderer/metrics/metrics.h"

namespace penumbra::metrics {
namespace {

/// One row, one light.
ImageF row(const std::vector<float>& values) {
  ImageF image(static_cast<std::uint32_t>(values.size()), 1, 1);
  image.pixels = values;
  return image;
}

TEST(VisibilityError, CountsFalseAndMissingShadowsApart) {
  const VisibilityError error = visibility_error(row({0.0f, 0.5f, 1.0f, 1.0f}),
                                                 row({1.0f, 0.0f, 0.0f, 1.0f}), row({1, 1, 1, 1}));
  EXPECT_EQ(error.judged, 4u);
  EXPECT_DOUBLE_EQ(error.false_shadow, 0.25);
  EXPECT_DOUBLE_EQ(error.missing_shadow, 0.5);
  EXPECT_DOUBLE_EQ(error.bias, (-1.0 + 0.5 + 1.0) / 4.0);
  EXPECT_DOUBLE_EQ(error.rms, std::sqrt((1.0 + 0.25 + 1.0) / 4.0));
}

TEST(VisibilityError, LetsDifferencesUpToATenthPass) {
  const VisibilityError error =
      visibility_error(row({0.4375f, 0.5625f}), row({0.5f, 0.5f}), row({1, 1}));
  EXPECT_EQ(error.false_shadow, 0.0);
  EXPECT_EQ(error.missing_shadow, 0.0);
  EXPECT_EQ(error.bias, 0.0);
  EXPECT_DOUBLE_EQ(error.rms, 0.0625);
}

TEST(VisibilityError, LooksOnlyWhereMoreThanHalfAPixelIsJudged) {
  const VisibilityError error =
      visibility_error(row({0, 0, 0}), row({1, 1, 1}), row({0.5f, 0.51f, 0.0f}));
  EXPECT_EQ(error.judged, 1u);
  EXPECT_DOUBLE_EQ(error.rms, 1.0);
}

TEST(VisibilityError, CountsEveryLight) {
  ImageF visibility(1, 1, 2, 0.0f);
  ImageF reference(1, 1, 2, 0.0f);
  reference.at(0, 0, 1) = 1.0f;
  const VisibilityError error = visibility_error(visibility, reference, ImageF(1, 1, 2, 1.0f));
  EXPECT_EQ(error.judged, 2u);
  EXPECT_DOUBLE_EQ(error.false_shadow, 0.5);
}

TEST(VisibilityError, IsZeroWhereNothingIsJudged) {
  const VisibilityError error = visibility_error(row({0, 1}), row({1, 0}), row({0, 0}));
  EXPECT_EQ(error.judged, 0u);
  EXPECT_EQ(error.rms, 0.0);
  EXPECT_EQ(error.bias, 0.0);
  EXPECT_EQ(error.false_shadow, 0.0);
  EXPECT_EQ(error.missing_shadow, 0.0);
}

TEST(VisibilityError, CountsWhatIsNoNumberAsFullyWrong) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const VisibilityError error =
      visibility_error(row({nan, -infinity}), row({1.0f, 0.0f}), row({1, 1}));
  EXPECT_DOUBLE_EQ(error.rms, 1.0);
  EXPECT_DOUBLE_EQ(error.false_shadow, 0.5);
  EXPECT_DOUBLE_EQ(error.missing_shadow, 0.5);
}

TEST(VisibilityError, RefusesPicturesOfDifferentShapes) {
  EXPECT_THROW(visibility_error(ImageF(2, 2, 1), ImageF(2, 2, 2), ImageF(2, 2, 1)), Error);
  EXPECT_THROW(visibility_error(ImageF(2, 2, 1), ImageF(2, 2, 1), ImageF(2, 3, 1)), Error);
}

}  // namespace
}  // namespace penumbra::metrics
