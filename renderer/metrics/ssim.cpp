#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "renderer/metrics/check.h"
#include "renderer/metrics/metrics.h"
#include "renderer/metrics/rows.h"

namespace penumbra::metrics {
namespace {

constexpr std::size_t window = 11;  // pixels, Wang et al. 2004, section III-B
constexpr double sigma = 1.5;       // pixels
constexpr double c1 = (0.01 * 255.0) * (0.01 * 255.0);
constexpr double c2 = (0.03 * 255.0) * (0.03 * 255.0);

std::array<double, window> gaussian() {
  std::array<double, window> kernel{};
  double sum = 0.0;
  for (std::size_t i = 0; i < window; ++i) {
    const double offset = static_cast<double>(i) - static_cast<double>(window / 2);
    kernel[i] = std::exp(-offset * offset / (2.0 * sigma * sigma));
    sum += kernel[i];
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

/// Moments that the index is made of: means, mean squares, mean product.
enum Plane : std::size_t { mean_a, mean_b, square_a, square_b, product, planes };

/// Moments before filtering, of one row.
template <class T>
void read_row(const Image<T>& picture, const Image<T>& reference, std::uint32_t y, RowRing& raw) {
  for (std::uint32_t x = 0; x < picture.width; ++x) {
    const double a = luma(&picture.at(x, y, 0));
    const double b = luma(&reference.at(x, y, 0));
    raw.row(mean_a, 0)[x] = a;
    raw.row(mean_b, 0)[x] = b;
    raw.row(square_a, 0)[x] = a * a;
    raw.row(square_b, 0)[x] = b * b;
    raw.row(product, 0)[x] = a * b;
  }
}

double index_of(double a, double b, double aa, double bb, double ab) {
  const double variance_a = std::max(aa - a * a, 0.0);
  const double variance_b = std::max(bb - b * b, 0.0);
  const double covariance = ab - a * b;
  return (2.0 * a * b + c1) * (2.0 * covariance + c2) /
         ((a * a + b * b + c1) * (variance_a + variance_b + c2));
}

/// Sums of the index over each row of places of the window, from the first to before the last.
template <class T>
void sum_similarities(const Image<T>& picture, const Image<T>& reference, std::uint32_t first,
                      std::uint32_t last, std::vector<double>& sums) {
  const std::array<double, window> kernel = gaussian();
  const std::size_t width = picture.width - window + 1;
  const Columns all{0, width};
  RowRing raw(planes, picture.width, 1);
  RowRing filtered(planes, width, window);
  RowRing moments(planes, width, 1);
  for (std::uint32_t y = first; y < last + window - 1; ++y) {
    read_row(picture, reference, y, raw);
    for (std::size_t plane = 0; plane < planes; ++plane)
      filter_row(raw.row(plane, 0), kernel, filtered.row(plane, y), all);
    if (y + 1 < first + window) continue;

    // The window ends at this row.
    const std::size_t top = y + 1 - window;
    for (std::size_t plane = 0; plane < planes; ++plane) {
      const std::span<double> out = moments.row(plane, 0);
      std::fill(out.begin(), out.end(), 0.0);
      add_filtered(
          kernel, [&](std::size_t j) { return filtered.row(plane, top + j).data(); }, out, all);
    }
    for (std::size_t x = 0; x < width; ++x)
      sums[top] += index_of(moments.row(mean_a, 0)[x], moments.row(mean_b, 0)[x],
                            moments.row(square_a, 0)[x], moments.row(square_b, 0)[x],
                            moments.row(product, 0)[x]);
  }
}

template <class T>
double ssim_of(const Image<T>& picture, const Image<T>& reference) {
  check_pair(picture, reference);
  if (picture.width < window || picture.height < window)
    throw bad_value("picture", "SSIM needs pictures of at least 11x11 pixels, not " +
                                   shape_text(picture.width, picture.height));
  const auto rows = static_cast<std::uint32_t>(picture.height - window + 1);
  std::vector<double> sums(rows);
  for_bands(rows, [&](std::uint32_t first, std::uint32_t last) {
    sum_similarities(picture, reference, first, last, sums);
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0) /
         (static_cast<double>(picture.width - window + 1) * rows);
}

}  // namespace

double ssim(const Image8& picture, const Image8& reference) {
  return ssim_of(picture, reference);
}

double ssim(const ImageF& picture, const ImageF& reference) {
  return ssim_of(picture, reference);
}

}  // namespace penumbra::metrics
