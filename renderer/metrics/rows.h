#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <future>
#include <span>
#include <thread>
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

/// Columns [begin, end) of a row.
struct Columns {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// out[x] += sum over j of kernel[j] * in(j)[x] for the columns. `in(j)` returns a pointer to what
/// the j-th weight is multiplied with. Sums of neighbours stay in registers.
template <class In>
void add_filtered(std::span<const double> kernel, const In& in, std::span<double> out,
                  const Columns& columns) {
  constexpr std::size_t together = 8;
  std::size_t x = columns.begin;
  for (; x + together <= columns.end; x += together) {
    double sums[together];
    std::copy_n(&out[x], together, sums);
    for (std::size_t j = 0; j < kernel.size(); ++j) {
      const double* values = in(j) + x;
      for (std::size_t k = 0; k < together; ++k) sums[k] += kernel[j] * values[k];
    }
    std::copy_n(sums, together, &out[x]);
  }
  for (; x < columns.end; ++x)
    for (std::size_t j = 0; j < kernel.size(); ++j) out[x] += kernel[j] * in(j)[x];
}

/// out[x] = sum over j of kernel[j] * in[x + j] for the columns; `in` is longer by the kernel's
/// size - 1.
inline void filter_row(std::span<const double> in, std::span<const double> kernel,
                       std::span<double> out, const Columns& columns) {
  std::fill(&out[columns.begin], out.data() + columns.end, 0.0);
  add_filtered(
      kernel, [&](std::size_t j) { return in.data() + j; }, out, columns);
}

/// Calls work(first, last) for bands of rows that make up [0, rows), each in a thread where there
/// are any. What it computes of a row must not depend on the band.
template <class Work>
void for_bands(std::uint32_t rows, const Work& work) {
  constexpr std::uint32_t least_rows = 32;
  const std::uint32_t bands =
      std::clamp(std::thread::hardware_concurrency(), 1u, std::max(rows / least_rows, 1u));
  const auto begin = [&](std::uint32_t band) {
    return static_cast<std::uint32_t>(std::uint64_t{rows} * band / bands);
  };
  std::vector<std::future<void>> others;
  // Without a policy, what no thread can be had for is done by get().
  for (std::uint32_t band = 1; band < bands; ++band)
    others.push_back(
        std::async([&work, first = begin(band), last = begin(band + 1)] { work(first, last); }));
  work(0u, begin(1));
  for (std::future<void>& other : others) other.get();
}

}  // namespace penumbra::metrics
