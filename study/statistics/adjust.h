#pragma once

#include <vector>

namespace penumbra::study::statistics {

/// Adjusted p-values of a family, in the order given, at most 1. A NaN (a test that could not be
/// made) stays NaN and does not count towards the family.
std::vector<double> adjust_bonferroni(const std::vector<double>& p);
std::vector<double> adjust_holm(const std::vector<double>& p);
std::vector<double> adjust_hochberg(const std::vector<double>& p);

/// Shaffer's static procedure for all pairs of `k` treatments (1986); p has k(k-1)/2 values.
std::vector<double> adjust_shaffer(const std::vector<double>& p, int k);

/// S(k): how many of the pairs of k treatments can be true null hypotheses at once, ascending.
std::vector<int> shaffer_counts(int k);

/// Multiplier of the i-th smallest p in Shaffer's static procedure.
std::vector<int> shaffer_multipliers(int k);

}  // namespace penumbra::study::statistics
