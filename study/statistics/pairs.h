#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::study::statistics {

/// Student's paired test of differences a - b.
struct PairedT {
  std::size_t n = 0;
  std::optional<double> mean_difference;
  std::optional<double> t;
  std::size_t df = 0;
  std::optional<double> p_value;
  std::optional<double> dz;                      ///< mean difference / its standard deviation
  std::optional<std::array<double, 2>> dz_ci95;  ///< from the noncentral t
  std::string reason;  ///< why t is missing. Equal differences: p 0, the limit of an unbounded t;
                       ///< all zero: p 1
};
PairedT paired_t(const std::vector<double>& differences);

/// Wilcoxon's signed rank of differences a - b, by the rules of R 4.2's wilcox.test: zeros dropped;
/// exact below 50 differences without ties or zeros, otherwise normal with tie and continuity
/// correction.
struct SignedRank {
  std::size_t n = 0;        ///< differences that are not zero
  std::optional<double> v;  ///< sum of the ranks of positive differences
  std::optional<double> p_value;
  bool exact = false;
  std::optional<double>
      p_exact_conditional;              ///< permutation of the mid-ranks, up to 100 differences
  std::optional<double> rank_biserial;  ///< (W+ - W-) / (W+ + W-)
  std::optional<std::array<double, 2>> rank_biserial_ci95;  ///< Fisher's z with the standard error
                                                            ///< of W (as R's effectsize)
  /// Pratt's rule (1959): zeros are ranked with the others and then dropped. Normal without
  /// continuity correction, as R's coin; exact up to 100 differences.
  std::optional<double> p_pratt;
  std::optional<double> p_pratt_exact;
  std::string reason;
};
SignedRank signed_rank(const std::vector<double>& differences);

/// Differences that no exact test can call significant: the smallest two-sided p of n of them is
/// 2^(1-n), which `tests` of one family multiply. Returns the fewest n that can reach `alpha`.
std::size_t fewest_for_exact(std::size_t tests, double alpha);

/// Sign test: lower is better, so a negative difference a - b is a win for a.
struct SignTest {
  std::size_t n = 0;  ///< ties included
  std::size_t wins_a = 0;
  std::size_t wins_b = 0;
  std::optional<double> probability_a_better;  ///< ties count half
  std::optional<std::array<double, 2>> ci95;   ///< Clopper-Pearson, ties count half
  std::optional<double> p_value;               ///< exact, two-sided, ties dropped
  std::string reason;
};
SignTest sign_test(const std::vector<double>& differences);

}  // namespace penumbra::study::statistics
