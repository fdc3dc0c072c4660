#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace penumbra::metrics {

/// The newest `count` rows of several planes. Separable filters go down a picture with it: each row
/// is filtered horizontally once, and memory grows with the width of a picture, not with its area.
class RowRing {
 public:
  RowRing(std::size_t planes_, std::size_t width_, std::size_t count_)
      : planes(planes_), width(width_), count(count_), values(planes_ * width_ * count_) {}

  std::span<double> row(std::size_t plane, std::size_t y) {
    return std::span(values).subspan(((y % count) * planes + plane) * width, width);
  }
  std::span<const double> row(std::size_t plane, std::size_t y) const {
    return std::span(values).subspan(((y % count) * planes + plane) * width, width);
  }

 private:
  std::size_t planes;
  std::size_t width;
  std::size_t count;
  std::vector<double> values;
};

/// out[x] += weight * in[x]
inline void add_scaled(std::span<const double> in, double weight, std::span<double> out) {
  for (std::size_t x = 0; x < out.size(); ++x) out[x] += weight * in[x];
}

/// out[x] = sum over j of kernel[j] * in[x + j]; `in` is longer by the kernel's size - 1.
inline void filter_row(std::span<const double> in, std::span<const double> kernel,
                       std::span<double> out) {
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t j = 0; j < kernel.size(); ++j)
    add_scaled(in.subspan(j, out.size()), kernel[j], out);
}

}  // namespace penumbra::metrics
