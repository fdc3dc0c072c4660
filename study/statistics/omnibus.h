#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/statistics/table.h"

namespace penumbra::study::statistics {

/// A test that follows chi-square. Without a statistic, `reason` says why.
struct ChiSquareTest {
  std::optional<double> statistic;
  int df = 0;
  std::optional<double> p_value;
  std::string reason;
};

/// A test that follows F. An unbounded statistic (blocks agree wholly) is empty, with p 0.
struct FTest {
  std::optional<double> f;
  int df1 = 0;
  int df2 = 0;
  std::optional<double> p_value;
  std::string reason;
};

enum class BlockWeights {
  unit,           ///< Friedman on complete blocks, Durbin on balanced incomplete ones
  skillings_mack  ///< sqrt(12 / (treatments in the block + 1)) (Skillings and Mack 1981)
};

/// Quadratic form of centred within-block rank sums with the pseudo-inverse of their permutation
/// covariance, ties included: chi-square with the covariance's rank as degrees of freedom.
/// `weights` (one per block, or empty) multiply the blocks' ranks: weighted Friedman. Blocks with
/// fewer than two values are left out.
ChiSquareTest rank_sum_test(const Table& table, BlockWeights kind,
                            const std::vector<double>& weights = {});

struct Friedman {
  ChiSquareTest test;                ///< tie-corrected
  std::optional<double> kendalls_w;  ///< chi2 / (n (k - 1)), complete blocks only
  FTest iman_davenport;              ///< (n-1) chi2 / (n (k-1) - chi2), complete blocks only
};
Friedman friedman(const Table& table);

/// Quade (1979) on the complete blocks: ranks weighted by the rank of the block's range.
FTest quade(const Table& table);

/// Blocks without a missing value.
Table complete_blocks(const Table& table);

/// Sums over blocks of within-block mid-ranks, complete blocks.
std::vector<double> rank_sums(const Table& table);

}  // namespace penumbra::study::statistics
