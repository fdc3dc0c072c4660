#pragma once

#include <optional>
#include <vector>

namespace penumbra::study::statistics {

/// Rank correlations of two lists of equal length; places where either is missing (NaN) are left
/// out. Empty where fewer than two places are left or one list is constant.
std::optional<double> spearman(const std::vector<double>& a, const std::vector<double>& b);
std::optional<double> kendall_tau_b(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace penumbra::study::statistics
