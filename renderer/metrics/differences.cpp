#include <cmath>
#include <limits>

#include "renderer/metrics/check.h"
#include "renderer/metrics/metrics.h"

namespace penumbra::metrics {
namespace {

/// Mean of `of_pixel(picture pixel, reference pixel)`, a whole number below 2^37. Rows are summed
/// in integers, so that the result does not depend on the order of the sums inside them.
template <class OfPixel>
double mean_over_pixels(const Image8& picture, const Image8& reference, OfPixel of_pixel) {
  check_pair(picture, reference);
  double sum = 0.0;
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    std::uint64_t row = 0;
    for (std::uint32_t x = 0; x < picture.width; ++x)
      row += of_pixel(&picture.at(x, y, 0), &reference.at(x, y, 0));
    sum += static_cast<double>(row);
  }
  return sum / static_cast<double>(picture.pixel_count());
}

/// Mean of `of_pixel` of two pictures with fractions.
template <class OfPixel>
double mean_square(const ImageF& picture, const ImageF& reference, OfPixel of_pixel) {
  check_pair(picture, reference);
  double sum = 0.0;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x)
      sum += of_pixel(&picture.at(x, y, 0), &reference.at(x, y, 0));
  return sum / static_cast<double>(picture.pixel_count());
}

/// A value that is no number is judged as the visibility farthest from the reference: a broken
/// technique must not come off better than a wrong one, and no sum may become NaN.
double judged_value(float visibility, float reference) {
  if (std::isfinite(visibility)) return visibility;
  return reference < 0.5f ? 1.0 : 0.0;
}

std::uint8_t level(double value) {
  return static_cast<std::uint8_t>(std::lround(255.0 * value));
}

}  // namespace

double rms_y(const Image8& picture, const Image8& reference) {
  const auto squared = [](const std::uint8_t* a, const std::uint8_t* b) {
    const std::int64_t difference = luma_thousandths(a) - luma_thousandths(b);
    return static_cast<std::uint64_t>(difference * difference);
  };
  return std::sqrt(mean_over_pixels(picture, reference, squared)) / 1000.0;
}

double psnr(const Image8& picture, const Image8& reference) {
  const auto squared = [](const std::uint8_t* a, const std::uint8_t* b) {
    std::uint64_t sum = 0;
    for (int c = 0; c < 3; ++c) sum += static_cast<std::uint64_t>((a[c] - b[c]) * (a[c] - b[c]));
    return sum;
  };
  const double mean_squared = mean_over_pixels(picture, reference, squared) / 3.0;
  if (mean_squared == 0.0) return std::numeric_limits<double>::infinity();
  return 10.0 * std::log10(255.0 * 255.0 / mean_squared);
}

double rms_y(const ImageF& picture, const ImageF& reference) {
  return std::sqrt(mean_square(picture, reference, [](const float* a, const float* b) {
    return (luma(a) - luma(b)) * (luma(a) - luma(b));
  }));
}

double psnr(const ImageF& picture, const ImageF& reference) {
  const double mean_squared = mean_square(picture, reference, [](const float* a, const float* b) {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c)
      sum += (static_cast<double>(a[c]) - static_cast<double>(b[c])) *
             (static_cast<double>(a[c]) - static_cast<double>(b[c]));
    return sum / 3.0;
  });
  if (mean_squared == 0.0) return std::numeric_limits<double>::infinity();
  return 10.0 * std::log10(255.0 * 255.0 / mean_squared);
}

VisibilityError visibility_error(const ImageF& visibility, const ImageF& reference,
                                 const ImageF& judged) {
  for (const ImageF* other : {&reference, &judged})
    if (other->width != visibility.width || other->height != visibility.height ||
        other->channels != visibility.channels || other->pixels.size() != visibility.pixels.size())
      throw bad_value("visibility", "visibility, reference and judged must have the same shape");

  VisibilityError error;
  double squares = 0.0;
  double sum = 0.0;
  std::size_t darker = 0;
  std::size_t lighter = 0;
  for (std::size_t i = 0; i < visibility.pixels.size(); ++i) {
    if (!(judged.pixels[i] > 0.5f)) continue;
    const float truth = reference.pixels[i];
    if (!std::isfinite(truth))
      throw bad_value("reference", "the reference's visibility has values that are no numbers");
    const double difference = judged_value(visibility.pixels[i], truth) - double{truth};
    squares += difference * difference;
    sum += difference;
    if (difference < -0.1) ++darker;
    if (difference > 0.1) ++lighter;
    ++error.judged;
  }
  if (error.judged == 0) return error;
  const double count = static_cast<double>(error.judged);
  error.rms = std::sqrt(squares / count);
  error.bias = sum / count;
  error.false_shadow = static_cast<double>(darker) / count;
  error.missing_shadow = static_cast<double>(lighter) / count;
  return error;
}

Image8 error_map(const Image8& picture, const Image8& reference, double full_scale) {
  check_pair(picture, reference);
  if (!(full_scale > 0.0 && full_scale <= 255.0))
    throw bad_value("full_scale", "full_scale must be above 0 and at most 255");
  Image8 map(picture.width, picture.height, 4, 255);
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      const int thousandths =
          luma_thousandths(&picture.at(x, y, 0)) - luma_thousandths(&reference.at(x, y, 0));
      const double share = thousandths / (1000.0 * full_scale);
      const std::uint8_t paleness = level(1.0 - std::min(std::abs(share), 1.0));
      map.at(x, y, 1) = paleness;
      if (share < 0.0) map.at(x, y, 0) = paleness;
      if (share > 0.0) map.at(x, y, 2) = paleness;
    }
  }
  return map;
}

}  // namespace penumbra::metrics
