#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::study::statistics {

/// Of one technique over participants.
struct Descriptives {
  std::size_t n = 0;
  std::optional<double> mean;
  std::optional<double> weighted_mean;        ///< sum(w r) / sum(w)
  std::optional<double> weighted_se;          ///< robust (HC1)
  std::optional<double> effective_n;          ///< Kish: (sum w)^2 / sum(w^2)
  std::optional<double> sd;                   ///< n - 1
  std::optional<std::array<double, 2>> ci95;  ///< of the mean, Student's t
  std::optional<double> median;
  std::string reason;  ///< of what is missing
};

/// `weights` are as many as `values`, none negative. Zero weights leave the weighted mean empty.
Descriptives describe(const std::vector<double>& values, const std::vector<double>& weights);

}  // namespace penumbra::study::statistics
