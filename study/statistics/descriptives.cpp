#include "study/statistics/descriptives.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/statistics/distributions.h"

namespace penumbra::study::statistics {

namespace {

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

void describe_weighted(const std::vector<double>& values, const std::vector<double>& weights,
                       Descriptives& result) {
  double sum = 0.0;
  double sum_squares = 0.0;
  double product = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += weights[i];
    sum_squares += weights[i] * weights[i];
    product += weights[i] * values[i];
  }
  if (!(sum > 0.0)) {
    result.reason = "all weights are zero";
    return;
  }
  result.weighted_mean = product / sum;
  result.effective_n = sum * sum / sum_squares;
  if (values.size() < 2) return;
  const auto n = static_cast<double>(values.size());
  double spread = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double part = weights[i] * (values[i] - *result.weighted_mean);
    spread += part * part;
  }
  result.weighted_se = std::sqrt(n / (n - 1.0) * spread) / sum;
}

}  // namespace

Descriptives describe(const std::vector<double>& values, const std::vector<double>& weights) {
  Descriptives result;
  result.n = values.size();
  if (values.empty()) {
    result.reason = "no answers";
    return result;
  }
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  result.mean = mean;
  result.median = median_of(values);
  describe_weighted(values, weights, result);
  if (values.size() < 2) {
    result.reason += result.reason.empty() ? "one participant has no spread" : "";
    return result;
  }
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  result.sd = std::sqrt(squares / (n - 1.0));
  const double half = t_quantile(0.975, n - 1.0) * *result.sd / std::sqrt(n);
  result.ci95 = {mean - half, mean + half};
  return result;
}

}  // namespace penumbra::study::statistics
