#include "study/statistics/pairs.h"

#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "study/statistics/distributions.h"
#include "study/statistics/table.h"

namespace penumbra::study::statistics {

namespace {

constexpr std::size_t exact_below = 50;  // R's wilcox.test
constexpr std::size_t conditional_at_most = 100;

/// Distribution of twice W+ when every sign is a fair coin: probability of each sum.
std::vector<double> signed_rank_distribution(const std::vector<std::int64_t>& doubled) {
  std::size_t reach = 0;
  std::vector<double> probability{1.0};
  for (const std::int64_t rank : doubled) {
    const auto step = static_cast<std::size_t>(rank);
    probability.resize(reach + step + 1, 0.0);
    for (std::size_t sum = reach + step + 1; sum-- > 0;) {
      const double with = sum >= step ? probability[sum - step] : 0.0;
      probability[sum] = 0.5 * (probability[sum] + with);
    }
    reach += step;
  }
  return probability;
}

/// Twice the smaller tail, at most 1.
double exact_p(const std::vector<std::int64_t>& doubled, std::int64_t twice_v) {
  const auto probability = signed_rank_distribution(doubled);
  double lower = 0.0;
  double upper = 0.0;
  for (std::size_t sum = 0; sum < probability.size(); ++sum) {
    if (static_cast<std::int64_t>(sum) <= twice_v) lower += probability[sum];
    if (static_cast<std::int64_t>(sum) >= twice_v) upper += probability[sum];
  }
  return std::min(1.0, 2.0 * std::min(lower, upper));
}

/// Normal approximation with tie correction sum(t^3 - t) / 48 and continuity correction.
double normal_p(const std::vector<double>& sizes, double v) {
  const auto n = static_cast<double>(sizes.size());
  auto sorted = sizes;
  std::sort(sorted.begin(), sorted.end());
  double ties = 0.0;
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin;
    while (end < sorted.size() && sorted[end] == sorted[begin]) ++end;
    const auto t = static_cast<double>(end - begin);
    ties += t * t * t - t;
    begin = end;
  }
  const double sigma = std::sqrt(n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0);
  double z = v - n * (n + 1.0) / 4.0;
  z -= z > 0.0 ? 0.5 : z < 0.0 ? -0.5 : 0.0;
  return std::min(1.0, 2.0 * normal_tail(std::abs(z) / sigma));
}

/// tanh(atanh(r) +- 1.96 s / W) with s the standard deviation of W+ - W- and W = n (n + 1) / 2;
/// [r, 1] or [-1, r] shrink to the point where r is 1 or -1.
std::array<double, 2> biserial_interval(double r, double n) {
  const double error = std::sqrt(n * (n + 1.0) * (2.0 * n + 1.0) / 6.0) / (0.5 * n * (n + 1.0));
  const double half = normal_quantile(0.975) * error;
  if (std::abs(r) >= 1.0) return {r, r};
  return {std::tanh(std::atanh(r) - half), std::tanh(std::atanh(r) + half)};
}

/// Ranks zeros with the others, then drops them: p by the normal, and exact.
void add_pratt(const std::vector<double>& differences, SignedRank& result) {
  std::vector<double> sizes;
  for (const double value : differences) sizes.push_back(std::abs(value));
  const auto doubled = doubled_ranks(sizes);
  std::vector<std::int64_t> kept;
  std::int64_t twice_v = 0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    if (differences[i] == 0.0) continue;
    kept.push_back(doubled[i]);
    twice_v += differences[i] > 0.0 ? doubled[i] : 0;
    sum += static_cast<double>(doubled[i]);
    squares += static_cast<double>(doubled[i]) * static_cast<double>(doubled[i]);
  }
  const double z = (2.0 * static_cast<double>(twice_v) - sum) / std::sqrt(squares);
  result.p_pratt = std::min(1.0, 2.0 * normal_tail(std::abs(z)));
  if (kept.size() <= conditional_at_most) result.p_pratt_exact = exact_p(kept, twice_v);
}

}  // namespace

PairedT paired_t(const std::vector<double>& differences) {
  PairedT result;
  result.n = differences.size();
  if (result.n == 0) {
    result.reason = "no participant saw both";
    return result;
  }
  const auto n = static_cast<double>(result.n);
  double mean = 0.0;
  for (const double value : differences) mean += value / n;
  result.mean_difference = mean;
  if (result.n < 2) {
    result.reason = "only one participant saw both";
    return result;
  }
  result.df = result.n - 1;
  double squares = 0.0;
  double largest = 0.0;
  for (const double value : differences) {
    squares += (value - mean) * (value - mean);
    largest = std::max(largest, std::abs(value));
  }
  const double error = std::sqrt(squares / (n - 1.0) / n);
  if (error <= 1e-14 * largest) {
    const bool none = largest == 0.0;
    result.p_value = none ? 1.0 : 0.0;
    result.reason = none ? "all differences are zero" : "all differences are equal: t is unbounded";
    return result;
  }
  result.t = mean / error;
  result.p_value = t_two_sided(*result.t, n - 1.0);
  result.dz = *result.t / std::sqrt(n);
  const auto bounds = noncentrality_interval(*result.t, n - 1.0);
  result.dz_ci95 = {bounds[0] / std::sqrt(n), bounds[1] / std::sqrt(n)};
  return result;
}

SignedRank signed_rank(const std::vector<double>& differences) {
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double value : differences) {
    if (value == 0.0) continue;
    sizes.push_back(std::abs(value));
    positive.push_back(value > 0.0);
  }
  SignedRank result;
  result.n = sizes.size();
  if (result.n == 0) {
    result.reason = differences.empty() ? "no participant saw both" : "all differences are zero";
    return result;
  }
  const auto doubled = doubled_ranks(sizes);
  std::int64_t twice_v = 0;
  std::int64_t twice_total = 0;
  bool ties = false;
  for (std::size_t i = 0; i < doubled.size(); ++i) {
    twice_total += doubled[i];
    twice_v += positive[i] ? doubled[i] : 0;
  }
  auto sorted = sizes;
  std::sort(sorted.begin(), sorted.end());
  ties = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  result.v = 0.5 * static_cast<double>(twice_v);
  result.rank_biserial =
      static_cast<double>(2 * twice_v - twice_total) / static_cast<double>(twice_total);
  result.rank_biserial_ci95 =
      biserial_interval(*result.rank_biserial, static_cast<double>(result.n));
  add_pratt(differences, result);
  if (result.n <= conditional_at_most) result.p_exact_conditional = exact_p(doubled, twice_v);
  const bool zeros = result.n < differences.size();
  result.exact = result.n < exact_below && !ties && !zeros;
  result.p_value = result.exact ? *result.p_exact_conditional : normal_p(sizes, *result.v);
  return result;
}

std::size_t fewest_for_exact(std::size_t tests, double alpha) {
  std::size_t n = 1;
  for (double p = static_cast<double>(std::max<std::size_t>(tests, 1)); !(p < alpha); p *= 0.5) ++n;
  return n;
}

SignTest sign_test(const std::vector<double>& differences) {
  SignTest result;
  result.n = differences.size();
  for (const double value : differences) {
    result.wins_a += value < 0.0 ? 1 : 0;
    result.wins_b += value > 0.0 ? 1 : 0;
  }
  if (result.n == 0) {
    result.reason = "no participant saw both";
    return result;
  }
  const auto n = static_cast<double>(result.n);
  const double wins =
      0.5 * (n + static_cast<double>(result.wins_a) - static_cast<double>(result.wins_b));
  result.probability_a_better = wins / n;
  result.ci95 = clopper_pearson(wins, n);
  namespace bm = boost::math;
  const std::size_t decided = result.wins_a + result.wins_b;
  if (decided == 0) {
    result.p_value = 1.0;
    result.reason = "all are tied";
    return result;
  }
  const bm::binomial coin(static_cast<double>(decided), 0.5);
  const auto fewer = static_cast<double>(std::min(result.wins_a, result.wins_b));
  result.p_value = std::min(1.0, 2.0 * bm::cdf(coin, fewer));
  return result;
}

}  // namespace penumbra::study::statistics
