#pragma once

#include <vector>

#include "study/statistics/table.h"

namespace penumbra::study::statistics {

/// All pairs i < j in the order (0,1), (0,2), .., (1,2), ..
struct Pair {
  std::size_t a = 0;
  std::size_t b = 0;
};
std::vector<Pair> all_pairs(std::size_t treatments);

/// Nemenyi's test on the complete blocks (Demsar 2006): p-values by all_pairs, already family-wise.
/// NaN without two complete blocks and two treatments.
std::vector<double> nemenyi(const Table& table);

/// Smallest difference of mean ranks that Nemenyi calls significant.
double nemenyi_critical_difference(std::size_t blocks, int treatments, double alpha);

/// Conover's t on rank sums after Friedman, complete blocks: unadjusted p-values by all_pairs, only
/// to be reported adjusted. Where all blocks agree (no variance left) p is 0 for unequal sums, 1
/// for equal ones; NaN without two complete blocks and two treatments.
std::vector<double> conover(const Table& table);

/// Exact P(|R_i - R_j| >= difference) of two of `treatments` rank sums over `blocks` blocks without
/// ties (Eisinga et al. 2017), by convolution of one block's distribution.
double exact_rank_sum_difference(int difference, int treatments, int blocks);

}  // namespace penumbra::study::statistics
