#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "renderer/metrics/check.h"
#include "renderer/metrics/color.h"
#include "renderer/metrics/metrics.h"
#include "renderer/metrics/rows.h"

namespace penumbra::metrics {
namespace {

using Kernel = std::vector<double>;

std::size_t radius_of(const Kernel& kernel) {
  return kernel.size() / 2;
}

double sum_of(const Kernel& kernel) {
  double sum = 0.0;
  for (const double weight : kernel) sum += weight;
  return sum;
}

/// exp(-decay x^2), x in pixels.
Kernel gaussian(std::size_t radius, double decay) {
  Kernel kernel(2 * radius + 1);
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    const double x = static_cast<double>(i) - static_cast<double>(radius);
    kernel[i] = std::exp(-decay * x * x);
  }
  return kernel;
}

/// Scales positive weights to sum 1 and negative ones to sum -1.
void balance(Kernel& kernel) {
  double positive = 0.0;
  double negative = 0.0;
  for (const double weight : kernel) (weight > 0.0 ? positive : negative) += std::abs(weight);
  for (double& weight : kernel) weight /= weight > 0.0 ? positive : negative;
}

/// One-dimensional factors of FLIP's filters: all of them are separable, or a sum of two that are.
struct Kernels {
  // Contrast sensitivity (table 1 of the paper): achromatic, red-green, blue-yellow in two parts.
  Kernel achromatic;
  Kernel red_green;
  Kernel blue_yellow_wide;
  Kernel blue_yellow_narrow;
  // Features (section 4.2): smoothing across, first and second derivative along.
  Kernel smooth;
  Kernel edge;
  Kernel point;

  explicit Kernels(double pixels_per_degree);
  std::size_t radius() const { return std::max(radius_of(achromatic), radius_of(smooth)); }
};

Kernels::Kernels(double pixels_per_degree) {
  // Spatial form of the sensitivities: a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
  constexpr double pi = std::numbers::pi;
  constexpr double b_widest = 0.04;
  const double deviation = std::sqrt(b_widest / (2.0 * pi * pi)) * pixels_per_degree;
  const auto csf_radius = static_cast<std::size_t>(std::ceil(3.0 * deviation));
  const auto part = [&](double b) {
    return gaussian(csf_radius, pi * pi / (b * pixels_per_degree * pixels_per_degree));
  };
  const auto normalized = [](Kernel kernel) {
    const double sum = sum_of(kernel);
    for (double& weight : kernel) weight /= sum;
    return kernel;
  };
  achromatic = normalized(part(0.0047));
  red_green = normalized(part(0.0053));

  // Two products of Gaussians share one total; its root goes into each factor.
  blue_yellow_wide = part(b_widest);
  blue_yellow_narrow = part(0.025);
  const double wide = 34.1 * std::sqrt(pi / b_widest);
  const double narrow = 13.5 * std::sqrt(pi / 0.025);
  const double total = wide * std::pow(sum_of(blue_yellow_wide), 2) +
                       narrow * std::pow(sum_of(blue_yellow_narrow), 2);
  for (double& weight : blue_yellow_wide) weight *= std::sqrt(wide / total);
  for (double& weight : blue_yellow_narrow) weight *= std::sqrt(narrow / total);

  // The detectors' deviation is half the width of an edge that people see, 0.082 degrees.
  const double sigma = 0.5 * 0.082 * pixels_per_degree;
  const auto feature_radius = static_cast<std::size_t>(std::ceil(3.0 * sigma));
  smooth = normalized(gaussian(feature_radius, 1.0 / (2.0 * sigma * sigma)));
  edge = smooth;
  point = smooth;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    const double x = static_cast<double>(i) - static_cast<double>(feature_radius);
    edge[i] *= -x;
    point[i] *= x * x / (sigma * sigma) - 1.0;
  }
  balance(edge);
  balance(point);
}

/// What the comparison of a row needs of each picture.
struct RowFeatures {
  std::vector<glm::dvec3> lab;  ///< Hunt-adjusted, after contrast sensitivity
  std::vector<double> edges;    ///< length of the gradient
  std::vector<double> points;
};

/// Columns of each row, in runs.
using RowRuns = std::vector<std::vector<Columns>>;

/// Where two pictures differ within some distance: elsewhere FLIP is zero, whatever is there.
/// Columns are told apart in blocks.
class Neighbourhoods {
 public:
  template <class T>
  Neighbourhoods(const Image<T>& picture, const Image<T>& reference, std::size_t radius)
      : width_(picture.width),
        blocks_((picture.width + block - 1) / block),
        marked_(picture.height, std::vector<char>(blocks_, 0)) {
    for (std::uint32_t y = 0; y < picture.height; ++y)
      for (std::uint32_t x = 0; x < picture.width; ++x)
        if (!std::equal(&picture.at(x, y, 0), &picture.at(x, y, 0) + 3, &reference.at(x, y, 0)))
          mark(x, y, radius);
  }

  /// Marks every row within the radius of a marked one.
  void widen(std::size_t radius) {
    const auto before = marked_;
    const std::size_t rows = marked_.size();
    for (std::size_t b = 0; b < blocks_; ++b) {
      std::size_t filled = 0;  // rows before it are marked already
      for (std::size_t y = 0; y < rows; ++y) {
        if (before[y][b] == 0) continue;
        const std::size_t last = std::min(y + radius + 1, rows);
        for (std::size_t row = std::max(filled, y - std::min(radius, y)); row < last; ++row)
          marked_[row][b] = 1;
        filled = last;
      }
    }
  }

  RowRuns runs() const {
    RowRuns rows(marked_.size());
    for (std::size_t y = 0; y < rows.size(); ++y)
      for (std::size_t b = 0; b < blocks_; ++b) {
        if (marked_[y][b] == 0) continue;
        if (rows[y].empty() || rows[y].back().end < b * block) rows[y].push_back({b * block, 0});
        rows[y].back().end = std::min((b + 1) * block, width_);
      }
    return rows;
  }

 private:
  static constexpr std::size_t block = 16;

  void mark(std::size_t x, std::size_t y, std::size_t radius) {
    const std::size_t last = std::min((x + radius) / block, blocks_ - 1);
    for (std::size_t b = (x - std::min(radius, x)) / block; b <= last; ++b) marked_[y][b] = 1;
  }

  std::size_t width_;
  std::size_t blocks_;
  std::vector<std::vector<char>> marked_;
};

/// What is compared, and what that takes to be filtered horizontally.
struct Extent {
  RowRuns compared;
  RowRuns filtered;

  template <class T>
  Extent(const Image<T>& picture, const Image<T>& reference, std::size_t radius) {
    Neighbourhoods near(picture, reference, radius);
    near.widen(radius);
    compared = near.runs();
    near.widen(radius);
    filtered = near.runs();
  }
};

/// Filters one picture row by row, downwards; borders repeat.
template <class T>
class FilteredPicture {
 public:
  /// `first`: the first row that is asked for.
  FilteredPicture(const Image<T>& picture_, const Kernels& kernels_, const Extent& extent_,
                  std::uint32_t first)
      : picture(picture_),
        kernels(kernels_),
        extent(extent_),
        radius(kernels_.radius()),
        padded(3, picture_.width + 2 * radius, 1),
        horizontal(planes, picture_.width, 2 * radius + 1),
        vertical(outputs, picture_.width, 1),
        rows_read(first - static_cast<std::uint32_t>(std::min<std::size_t>(first, radius))) {}

  /// Row `y`; rows must be asked for in order.
  void read(std::uint32_t y, RowFeatures& out);

 private:
  enum Plane : std::size_t { achromatic, red_green, wide, narrow, smooth, edge, point, planes };
  enum Output : std::size_t {
    lightness,
    red_green_out,
    blue_yellow,
    edge_x,
    edge_y,
    point_x,
    point_y,
    outputs
  };

  void pad_row(std::uint32_t y);
  void filter_horizontally(std::uint32_t y);
  void filter_vertically(std::uint32_t y, Plane plane, const Kernel& kernel, Output output);
  void find_features(const Columns& run, RowFeatures& out);

  const Image<T>& picture;
  const Kernels& kernels;
  const Extent& extent;
  std::size_t radius;
  RowRing padded;  ///< opponent colour of one row, its ends repeated
  RowRing horizontal;
  RowRing vertical;
  std::uint32_t rows_read;
};

template <class T>
void FilteredPicture<T>::pad_row(std::uint32_t y) {
  const std::size_t last = picture.width - 1;
  for (const Columns& run : extent.filtered[y]) {
    const std::size_t end = std::min<std::size_t>(run.end + radius, picture.width);
    for (std::size_t x = run.begin - std::min(run.begin, radius); x < end; ++x) {
      const T* pixel = &picture.at(static_cast<std::uint32_t>(x), y, 0);
      const glm::dvec3 opponent = opponent_from_linear(
          {linear_from_srgb(pixel[0]), linear_from_srgb(pixel[1]), linear_from_srgb(pixel[2])});
      for (std::size_t c = 0; c < 3; ++c)
        padded.row(c, 0)[radius + x] = opponent[static_cast<int>(c)];
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<double> row = padded.row(c, 0);
    std::fill_n(row.begin(), radius, row[radius]);
    std::fill_n(row.end() - static_cast<std::ptrdiff_t>(radius), radius, row[radius + last]);
  }
}

template <class T>
void FilteredPicture<T>::filter_horizontally(std::uint32_t y) {
  if (extent.filtered[y].empty()) return;
  pad_row(y);
  const auto filter = [&](std::size_t channel, const Kernel& kernel, Plane plane) {
    const auto row = std::span<const double>(padded.row(channel, 0));
    for (const Columns& run : extent.filtered[y])
      filter_row(row.subspan(radius - radius_of(kernel)), kernel, horizontal.row(plane, y), run);
  };
  filter(0, kernels.achromatic, achromatic);
  filter(1, kernels.red_green, red_green);
  filter(2, kernels.blue_yellow_wide, wide);
  filter(2, kernels.blue_yellow_narrow, narrow);
  filter(0, kernels.smooth, smooth);
  filter(0, kernels.edge, edge);
  filter(0, kernels.point, point);
}

template <class T>
void FilteredPicture<T>::filter_vertically(std::uint32_t y, Plane plane, const Kernel& kernel,
                                           Output output) {
  const auto last = static_cast<std::ptrdiff_t>(picture.height) - 1;
  const auto first =
      static_cast<std::ptrdiff_t>(y) - static_cast<std::ptrdiff_t>(radius_of(kernel));
  std::vector<const double*> rows;
  for (std::size_t j = 0; j < kernel.size(); ++j) {
    const auto row = std::clamp<std::ptrdiff_t>(first + static_cast<std::ptrdiff_t>(j), 0, last);
    rows.push_back(horizontal.row(plane, static_cast<std::size_t>(row)).data());
  }
  for (const Columns& run : extent.compared[y])
    add_filtered(
        kernel, [&](std::size_t j) { return rows[j]; }, vertical.row(output, 0), run);
}

template <class T>
void FilteredPicture<T>::find_features(const Columns& run, RowFeatures& out) {
  const auto value = [&](Output output, std::size_t x) { return vertical.row(output, 0)[x]; };
  for (std::size_t x = run.begin; x < run.end; ++x) {
    const glm::dvec3 rgb =
        linear_from_opponent({value(lightness, x), value(red_green_out, x), value(blue_yellow, x)});
    out.lab[x] = hunt_lab_from_linear(glm::clamp(rgb, 0.0, 1.0));
    // Detectors look at Y scaled to 0..1; the offset of 16 vanishes, their weights sum to 0.
    out.edges[x] = std::hypot(value(edge_x, x), value(edge_y, x)) / 116.0;
    out.points[x] = std::hypot(value(point_x, x), value(point_y, x)) / 116.0;
  }
}

template <class T>
void FilteredPicture<T>::read(std::uint32_t y, RowFeatures& out) {
  for (; rows_read < picture.height && rows_read <= y + radius; ++rows_read)
    filter_horizontally(rows_read);

  for (std::size_t output = 0; output < outputs; ++output)
    for (const Columns& run : extent.compared[y])
      std::fill(&vertical.row(output, 0)[run.begin], vertical.row(output, 0).data() + run.end, 0.0);
  filter_vertically(y, achromatic, kernels.achromatic, lightness);
  filter_vertically(y, red_green, kernels.red_green, red_green_out);
  filter_vertically(y, wide, kernels.blue_yellow_wide, blue_yellow);
  filter_vertically(y, narrow, kernels.blue_yellow_narrow, blue_yellow);
  filter_vertically(y, edge, kernels.smooth, edge_x);
  filter_vertically(y, smooth, kernels.edge, edge_y);
  filter_vertically(y, point, kernels.smooth, point_x);
  filter_vertically(y, smooth, kernels.point, point_y);

  out.lab.resize(picture.width);
  out.edges.resize(picture.width);
  out.points.resize(picture.width);
  for (const Columns& run : extent.compared[y]) find_features(run, out);
}

/// Colour difference 0..1: exponent 0.7, then the lower 0.4 of the range is given 0.95 of the
/// scale.
double color_error(const glm::dvec3& a, const glm::dvec3& b) {
  constexpr double exponent = 0.7;
  constexpr double knee = 0.4;
  constexpr double knee_error = 0.95;
  // The farthest apart that colours of the display get: green and blue.
  static const double largest = std::pow(
      hyab_distance(hunt_lab_from_linear({0.0, 1.0, 0.0}), hunt_lab_from_linear({0.0, 0.0, 1.0})),
      exponent);
  const double difference = std::pow(hyab_distance(a, b), exponent);
  const double at_knee = knee * largest;
  if (difference < at_knee) return knee_error * difference / at_knee;
  const double beyond = (difference - at_knee) / (largest - at_knee);
  return std::min(knee_error + beyond * (1.0 - knee_error), 1.0);
}

/// Difference of edges or points 0..1, whichever is larger; exponent 0.5.
double feature_error(double edges_a, double edges_b, double points_a, double points_b) {
  const double larger = std::max(std::abs(edges_a - edges_b), std::abs(points_a - points_b));
  return std::min(std::sqrt(larger / std::numbers::sqrt2), 1.0);
}

/// Sums of errors over each row, from the first to before the last.
template <class T>
void sum_rows(const Image<T>& picture, const Image<T>& reference, const Kernels& kernels,
              const Extent& extent, std::uint32_t first, std::uint32_t last,
              std::vector<double>& sums) {
  FilteredPicture filtered_picture(picture, kernels, extent, first);
  FilteredPicture filtered_reference(reference, kernels, extent, first);
  RowFeatures a;
  RowFeatures b;
  for (std::uint32_t y = first; y < last; ++y) {
    if (extent.compared[y].empty()) continue;
    filtered_picture.read(y, a);
    filtered_reference.read(y, b);
    for (const Columns& run : extent.compared[y])
      for (std::size_t x = run.begin; x < run.end; ++x) {
        const double color = color_error(a.lab[x], b.lab[x]);
        const double feature = feature_error(a.edges[x], b.edges[x], a.points[x], b.points[x]);
        sums[y] += std::pow(color, 1.0 - feature);
      }
  }
}

template <class T>
double flip_of(const Image<T>& picture, const Image<T>& reference, double pixels_per_degree) {
  check_pair(picture, reference);
  if (!(pixels_per_degree >= 1.0 && pixels_per_degree <= 1000.0))
    throw bad_value("pixels_per_degree", "pixels_per_degree must be from 1 to 1000");
  const Kernels kernels(pixels_per_degree);
  const Extent extent(picture, reference, kernels.radius());
  std::vector<double> sums(picture.height);
  for_bands(picture.height, [&](std::uint32_t first, std::uint32_t last) {
    sum_rows(picture, reference, kernels, extent, first, last, sums);
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0) /
         static_cast<double>(picture.pixel_count());
}

}  // namespace

double flip(const Image8& picture, const Image8& reference, double pixels_per_degree) {
  return flip_of(picture, reference, pixels_per_degree);
}

double flip(const ImageF& picture, const ImageF& reference, double pixels_per_degree) {
  return flip_of(picture, reference, pixels_per_degree);
}

}  // namespace penumbra::metrics
