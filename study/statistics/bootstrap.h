#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/statistics/table.h"

namespace penumbra::study::statistics {

/// How results are resampled; the same plan gives the same numbers on every machine.
struct Resampling {
  std::uint64_t seed = 2007;
  std::size_t resamples = 2000;  ///< at most; see resamples_for
  std::size_t permutations = 9999;
};

/// Resamples for that many blocks: fewer where blocks are so many that the interval has long become
/// the normal one, never below 500.
std::size_t resamples_for(const Resampling& plan, std::size_t blocks);

using Interval = std::array<double, 2>;

/// 95 % bias-corrected and accelerated interval (Efron 1987) of each column's mean; rows are drawn
/// whole with replacement, so that the unit is the participant. Empty where a column has fewer than
/// two values.
std::vector<std::optional<Interval>> bca_of_means(const Table& table, const Resampling& plan);

/// The same of Kendall's W (tie-corrected) over complete blocks; empty where W is.
std::optional<Interval> bca_of_kendalls_w(const Table& table, const Resampling& plan);

/// Permutation test of Friedman's statistic: each complete block's ranks in random order. Exact
/// where all arrangements are few, otherwise (1 + as extreme) / (1 + permutations).
struct PermutationTest {
  std::optional<double> p_value;
  std::size_t permutations = 0;
  bool exact = false;
  std::string reason;
};
PermutationTest permute_friedman(const Table& table, const Resampling& plan);

}  // namespace penumbra::study::statistics
