#pragma once

#include <vector>

namespace penumbra::study::statistics {

/// q_i with q_i^2 + q_j^2 close to the variance of every difference i - j (Firth 2000): least
/// squares of log variances. Empty below three items.
std::vector<double> quasi_errors(const std::vector<std::vector<double>>& covariance);

}  // namespace penumbra::study::statistics
