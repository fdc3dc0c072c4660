#pragma once

#include <gtest/gtest.h>

#include "renderer/image.h"
#include "renderer/metrics/metrics.h"

/// Comparisons for picture tests. When an expectation fails after one, the two pictures and the map
/// of their difference are written to build/failures (or the folder that PENUMBRA_FAILURES names),
/// and their paths are printed: TEST-NAME-N-picture.png, -truth.png, -error.png.
namespace penumbra::tests {

/// metrics::rms_y.
double rms_y(const Image8& picture, const Image8& truth);

/// metrics::visibility_error. What is kept are pictures of the first light's visibility.
metrics::VisibilityError visibility_error(const ImageF& visibility, const ImageF& truth,
                                          const ImageF& judged);

/// For EXPECT_TRUE: whether sizes and all pixels are equal; otherwise how many are not and the
/// first.
testing::AssertionResult same(const Image8& picture, const Image8& truth);
testing::AssertionResult same(const ImageF& picture, const ImageF& truth);

}  // namespace penumbra::tests
