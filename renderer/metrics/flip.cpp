#include <algorithm>
#include <cmath>
#include <numbers>

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

/// Filters one picture row by row, downwards; borders repeat.
template <class T>
class FilteredPicture {
 public:
  FilteredPicture(const Image<T>& picture_, const Kernels& kernels_)
      : picture(picture_),
        kernels(kernels_),
        radius(kernels_.radius()),
        padded(3, picture_.width + 2 * radius, 1),
        horizontal(planes, picture_.width, 2 * radius + 1),
        vertical(outputs, picture_.width, 1) {}

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

  void filter_horizontally(std::uint32_t y);
  void filter_vertically(std::uint32_t y, Plane plane, const Kernel& kernel, Output output);

  const Image<T>& picture;
  const Kernels& kernels;
  std::size_t radius;
  RowRing padded;  ///< opponent colour of one row, its ends repeated
  RowRing horizontal;
  RowRing vertical;
  std::uint32_t rows_read = 0;
};

template <class T>
void FilteredPicture<T>::filter_horizontally(std::uint32_t y) {
  const std::size_t last = picture.width - 1;
  for (std::size_t x = 0; x < picture.width; ++x) {
    const T* pixel = &picture.at(static_cast<std::uint32_t>(x), y, 0);
    const glm::dvec3 opponent = opponent_from_linear(
        {linear_from_srgb(pixel[0]), linear_from_srgb(pixel[1]), linear_from_srgb(pixel[2])});
    for (std::size_t c = 0; c < 3; ++c)
      padded.row(c, 0)[radius + x] = opponent[static_cast<int>(c)];
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<double> row = padded.row(c, 0);
    std::fill_n(row.begin(), radius, row[radius]);
    std::fill_n(row.end() - static_cast<std::ptrdiff_t>(radius), radius, row[radius + last]);
  }
  const auto filter = [&](std::size_t channel, const Kernel& kernel, Plane plane) {
    filter_row(std::span<const double>(padded.row(channel, 0)).subspan(radius - radius_of(kernel)),
               kernel, horizontal.row(plane, y));
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
  for (std::size_t j = 0; j < kernel.size(); ++j) {
    const auto row = std::clamp<std::ptrdiff_t>(first + static_cast<std::ptrdiff_t>(j), 0, last);
    add_scaled(horizontal.row(plane, static_cast<std::size_t>(row)), kernel[j],
               vertical.row(output, 0));
  }
}

template <class T>
void FilteredPicture<T>::read(std::uint32_t y, RowFeatures& out) {
  for (; rows_read < picture.height && rows_read <= y + radius; ++rows_read)
    filter_horizontally(rows_read);

  for (std::size_t output = 0; output < outputs; ++output)
    std::ranges::fill(vertical.row(output, 0), 0.0);
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
  const auto value = [&](Output output, std::size_t x) { return vertical.row(output, 0)[x]; };
  for (std::size_t x = 0; x < picture.width; ++x) {
    const glm::dvec3 rgb =
        linear_from_opponent({value(lightness, x), value(red_green_out, x), value(blue_yellow, x)});
    out.lab[x] = hunt_lab_from_linear(glm::clamp(rgb, 0.0, 1.0));
    // Detectors look at Y scaled to 0..1; the offset of 16 vanishes, their weights sum to 0.
    out.edges[x] = std::hypot(value(edge_x, x), value(edge_y, x)) / 116.0;
    out.points[x] = std::hypot(value(point_x, x), value(point_y, x)) / 116.0;
  }
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

template <class T>
double flip_of(const Image<T>& picture, const Image<T>& reference, double pixels_per_degree) {
  check_pair(picture, reference);
  if (!(pixels_per_degree >= 1.0 && pixels_per_degree <= 1000.0))
    throw bad_value("pixels_per_degree", "pixels_per_degree must be from 1 to 1000");
  const Kernels kernels(pixels_per_degree);
  FilteredPicture filtered_picture(picture, kernels);
  FilteredPicture filtered_reference(reference, kernels);
  RowFeatures a;
  RowFeatures b;
  double sum = 0.0;
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    filtered_picture.read(y, a);
    filtered_reference.read(y, b);
    for (std::size_t x = 0; x < picture.width; ++x) {
      const double color = color_error(a.lab[x], b.lab[x]);
      const double feature = feature_error(a.edges[x], b.edges[x], a.points[x], b.points[x]);
      sum += std::pow(color, 1.0 - feature);
    }
  }
  return sum / static_cast<double>(picture.pixel_count());
}

}  // namespace

double flip(const Image8& picture, const Image8& reference, double pixels_per_degree) {
  return flip_of(picture, reference, pixels_per_degree);
}

double flip(const ImageF& picture, const ImageF& reference, double pixels_per_degree) {
  return flip_of(picture, reference, pixels_per_degree);
}

}  // namespace penumbra::metrics
