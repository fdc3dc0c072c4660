#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace penumbra::study::statistics {

/// Rows are blocks (participants), columns treatments (techniques); a missing value is NaN. Values
/// that were averages are scaled to integers before they come here, so that equal is exactly equal.
using Table = std::vector<std::vector<double>>;

inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();
inline bool is_missing(double value) {
  return std::isnan(value);
}

/// Twice the mid-rank of each value, 2 for the smallest: integers, since float noise in averaged
/// ranks makes false non-ties.
inline std::vector<std::int64_t> doubled_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<std::int64_t> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      ranks[order[i]] = static_cast<std::int64_t>(begin + end + 1);
    }
    begin = end;
  }
  return ranks;
}

}  // namespace penumbra::study::statistics
