#include "study/statistics/adjust.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "renderer/error.h"

namespace penumbra::study::statistics {

namespace {

/// Indices of the numbers among `p`, smallest first.
std::vector<std::size_t> ascending(const std::vector<double>& p) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!std::isnan(p[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  return order;
}

using Multiplier = std::function<double(std::size_t place, std::size_t count)>;

/// Each p times its multiplier, never below the one before it.
std::vector<double> step_down(const std::vector<double>& p, const Multiplier& multiplier) {
  std::vector<double> adjusted = p;
  const auto order = ascending(p);
  double highest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    highest = std::max(highest, std::min(1.0, multiplier(i, order.size()) * p[order[i]]));
    adjusted[order[i]] = highest;
  }
  return adjusted;
}

}  // namespace

std::vector<double> adjust_bonferroni(const std::vector<double>& p) {
  const auto count = static_cast<double>(ascending(p).size());
  std::vector<double> adjusted = p;
  for (double& value : adjusted) {
    if (!std::isnan(value)) value = std::min(1.0, count * value);
  }
  return adjusted;
}

std::vector<double> adjust_holm(const std::vector<double>& p) {
  return step_down(p, [](std::size_t i, std::size_t n) { return static_cast<double>(n - i); });
}

std::vector<double> adjust_hochberg(const std::vector<double>& p) {
  std::vector<double> adjusted = p;
  const auto order = ascending(p);
  double lowest = 1.0;
  for (std::size_t i = order.size(); i-- > 0;) {
    lowest = std::min(lowest, static_cast<double>(order.size() - i) * p[order[i]]);
    adjusted[order[i]] = lowest;
  }
  return adjusted;
}

std::vector<double> adjust_shaffer(const std::vector<double>& p, int k) {
  const auto multipliers = shaffer_multipliers(k);
  if (multipliers.size() != p.size()) {
    throw bad_value("k", "Shaffer's procedure needs one p-value for each of the pairs");
  }
  const auto valid = ascending(p).size();
  return step_down(p, [&](std::size_t i, std::size_t) {
    // Fewer tests than pairs leave the last multipliers, which bound what can still be true.
    return static_cast<double>(std::min<std::size_t>(static_cast<std::size_t>(multipliers[i]),
                                                     std::max<std::size_t>(valid - i, 1)));
  });
}

std::vector<int> shaffer_counts(int k) {
  // True equalities split the treatments into groups; j of them in one group make j(j-1)/2 pairs.
  std::vector<std::set<int>> counts(static_cast<std::size_t>(std::max(k, 1)) + 1);
  counts[0] = {0};
  for (int n = 1; n <= k; ++n) {
    for (int group = 1; group <= n; ++group) {
      for (const int rest : counts[static_cast<std::size_t>(n - group)]) {
        counts[static_cast<std::size_t>(n)].insert(rest + group * (group - 1) / 2);
      }
    }
  }
  const auto& last = counts[static_cast<std::size_t>(std::max(k, 0))];
  return {last.begin(), last.end()};
}

std::vector<int> shaffer_multipliers(int k) {
  const auto counts = shaffer_counts(k);
  const int pairs = k * (k - 1) / 2;
  std::vector<int> multipliers;
  for (int i = 0; i < pairs; ++i) {
    // i hypotheses are rejected: at most pairs - i are true, and that many must be possible.
    const auto above = std::upper_bound(counts.begin(), counts.end(), pairs - i);
    multipliers.push_back(*(above - 1));
  }
  return multipliers;
}

}  // namespace penumbra::study::statistics
