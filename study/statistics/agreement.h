#pragma once

#include <optional>
#include <vector>

namespace penumbra::study::statistics {

/// Rank correlations of two lists of equal length; places where either is missing (NaN) are left
/// out. Empty where fewer than two places are left or one list is constant.
std::optional<double> spearman(const std::vector<double>& a, const std::vector<double>& b);
std::optional<double> kendall_tau_b(const std::vector<double>& a, const std::vector<double>& b);

/// Two lists of one stratum, a scene.
struct RankedList {
  std::vector<double> a;
  std::vector<double> b;
};
struct RankCorrelation {
  std::optional<double> rho;    ///< of ranks within strata, centred within strata
  std::optional<double> tau_b;  ///< of pairs within strata
};

/// Correlation of ranks within strata, pooled: between strata nothing is compared. One stratum
/// gives Spearman's rho and Kendall's tau-b.
RankCorrelation correlate_within(const std::vector<RankedList>& strata);

}  // namespace penumbra::study::statistics
