#include "study/statistics/bootstrap.h"

#include <cmath>

#include "study/random.h"
#include "study/statistics/distributions.h"
#include "study/statistics/omnibus.h"

namespace penumbra::study::statistics {

namespace {

// Streams of the random numbers of one analysis.
constexpr std::uint32_t stream_means = 200;
constexpr std::uint32_t stream_concordance = 201;
constexpr std::uint32_t stream_permutations = 202;

constexpr std::size_t most_draws = 5'000'000;  ///< rows drawn for one table
constexpr std::size_t fewest_resamples = 500;
constexpr std::size_t most_arrangements = 50'000;  ///< counted out one by one
constexpr std::size_t few_blocks = 30;             ///< beyond, chi-square serves

/// Value at place p (B + 1) of the ascending replicates, between neighbours linearly (Davison and
/// Hinkley 1997, 5.2).
double quantile(const std::vector<double>& ascending, double p) {
  const double last = static_cast<double>(ascending.size());
  const double place = std::clamp(p * (last + 1.0), 1.0, last);
  const auto below = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(below);
  const double low = ascending[below - 1];
  return below < ascending.size() ? low + part * (ascending[below] - low) : low;
}

/// `acceleration` is sum d^3 / (6 (sum d^2)^1.5) of the jackknife's deviations d.
Interval bca(double estimate, std::vector<double> replicates, double acceleration) {
  std::sort(replicates.begin(), replicates.end());
  if (replicates.front() == replicates.back()) return {replicates.front(), replicates.back()};
  const auto below = static_cast<double>(
      std::lower_bound(replicates.begin(), replicates.end(), estimate) - replicates.begin());
  const auto upto = static_cast<double>(
      std::upper_bound(replicates.begin(), replicates.end(), estimate) - replicates.begin());
  const auto count = static_cast<double>(replicates.size());
  // Ties with the estimate count half; an estimate beyond all replicates stays finite.
  const double share = std::clamp(0.5 * (below + upto), 0.5, count - 0.5) / count;
  const double bias = normal_quantile(share);
  const auto adjusted = [&](double p) {
    const double z = bias + normal_quantile(p);
    return 1.0 - normal_tail(bias + z / (1.0 - acceleration * z));
  };
  return {quantile(replicates, adjusted(0.025)), quantile(replicates, adjusted(0.975))};
}

double acceleration_of(const std::vector<double>& deviations) {
  double squares = 0.0;
  double cubes = 0.0;
  for (const double d : deviations) {
    squares += d * d;
    cubes += d * d * d;
  }
  return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

/// Doubled mid-ranks of complete blocks, and what Kendall's W needs of them.
struct Concordance {
  std::vector<std::vector<std::int64_t>> ranks;
  std::vector<double> spreads;  ///< per block, sum of squared deviations of its doubled ranks

  explicit Concordance(const Table& table) {
    for (const auto& row : complete_blocks(table)) {
      ranks.push_back(doubled_ranks(row));
      double spread = 0.0;
      for (const std::int64_t rank : ranks.back()) spread += square(static_cast<double>(rank));
      spreads.push_back(spread - static_cast<double>(treatments()) * square(mean()));
    }
  }

  static double square(double x) { return x * x; }
  std::size_t treatments() const { return ranks.empty() ? 0 : ranks.front().size(); }
  double mean() const { return static_cast<double>(treatments() + 1); }

  /// W = sum (R_j - mean R)^2 / (n sum of spreads), as Friedman's statistic / (n (k - 1)).
  double w(const std::vector<std::int64_t>& sums, double spread, double blocks) const {
    double between = 0.0;
    for (const std::int64_t sum : sums)
      between += square(static_cast<double>(sum) - blocks * mean());
    return spread > 0.0 ? between / (blocks * spread) : 0.0;
  }
};

}  // namespace

std::size_t resamples_for(const Resampling& plan, std::size_t blocks) {
  const std::size_t affordable = most_draws / std::max<std::size_t>(blocks, 1);
  return std::min(plan.resamples, std::max(affordable, fewest_resamples));
}

std::vector<std::optional<Interval>> bca_of_means(const Table& table, const Resampling& plan) {
  const std::size_t columns = table.empty() ? 0 : table.front().size();
  const std::size_t resamples = resamples_for(plan, table.size());
  std::vector<std::vector<double>> replicates(columns);
  Random random(plan.seed, stream_means);
  std::vector<double> sums(columns);
  std::vector<double> counts(columns);
  for (std::size_t i = 0; i < resamples; ++i) {
    std::fill(sums.begin(), sums.end(), 0.0);
    std::fill(counts.begin(), counts.end(), 0.0);
    for (std::size_t draw = 0; draw < table.size(); ++draw) {
      const auto& row = table[random.below(table.size())];
      for (std::size_t j = 0; j < columns; ++j) {
        if (is_missing(row[j])) continue;
        sums[j] += row[j];
        counts[j] += 1.0;
      }
    }
    for (std::size_t j = 0; j < columns; ++j) {
      if (counts[j] > 0.0) replicates[j].push_back(sums[j] / counts[j]);
    }
  }
  std::vector<std::optional<Interval>> intervals(columns);
  for (std::size_t j = 0; j < columns; ++j) {
    std::vector<double> deviations;
    double sum = 0.0;
    for (const auto& row : table) {
      if (is_missing(row[j])) continue;
      deviations.push_back(row[j]);
      sum += row[j];
    }
    if (deviations.size() < 2 || replicates[j].empty()) continue;
    const double mean = sum / static_cast<double>(deviations.size());
    // Leaving one out moves the mean against that one's deviation, all by the same factor.
    for (double& value : deviations) value -= mean;
    intervals[j] = bca(mean, std::move(replicates[j]), acceleration_of(deviations));
  }
  return intervals;
}

std::optional<Interval> bca_of_kendalls_w(const Table& table, const Resampling& plan) {
  const Concordance data(table);
  const std::size_t n = data.ranks.size();
  const std::size_t k = data.treatments();
  if (n < 2 || k < 2) return std::nullopt;
  std::vector<std::int64_t> total(k, 0);
  double spread = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < k; ++j) total[j] += data.ranks[i][j];
    spread += data.spreads[i];
  }
  if (!(spread > 0.0)) return std::nullopt;
  const auto blocks = static_cast<double>(n);

  // Draw whole blocks.
  std::vector<double> replicates;
  Random random(plan.seed, stream_concordance);
  for (std::size_t i = resamples_for(plan, n); i > 0; --i) {
    std::vector<std::int64_t> sums(k, 0);
    double drawn = 0.0;
    for (std::size_t draw = 0; draw < n; ++draw) {
      const std::size_t block = random.below(n);
      for (std::size_t j = 0; j < k; ++j) sums[j] += data.ranks[block][j];
      drawn += data.spreads[block];
    }
    replicates.push_back(data.w(sums, drawn, blocks));
  }

  // Leave one block out at a time.
  std::vector<double> left_out;
  for (std::size_t i = 0; i < n; ++i) {
    auto sums = total;
    for (std::size_t j = 0; j < k; ++j) sums[j] -= data.ranks[i][j];
    left_out.push_back(data.w(sums, spread - data.spreads[i], blocks - 1.0));
  }
  const double mean = std::accumulate(left_out.begin(), left_out.end(), 0.0) / blocks;
  for (double& value : left_out) value = mean - value;
  return bca(data.w(total, spread, blocks), std::move(replicates), acceleration_of(left_out));
}

namespace {

/// Sum over treatments of squared rank sums: grows with Friedman's statistic, and exact.
std::int64_t extremity(const std::vector<std::int64_t>& sums) {
  std::int64_t total = 0;
  for (const std::int64_t sum : sums) total += sum * sum;
  return total;
}

/// Counts arrangements of blocks `at` and later that are as extreme as `least`. Every block runs
/// through the distinct orders of its ranks, which are equally likely.
struct Arrangements {
  std::vector<std::vector<std::int64_t>> blocks;
  std::int64_t least = 0;
  std::size_t all = 0;
  std::size_t extreme = 0;

  void count(std::size_t at, const std::vector<std::int64_t>& sums) {
    if (at == blocks.size()) {
      ++all;
      extreme += extremity(sums) >= least ? 1 : 0;
      return;
    }
    auto order = blocks[at];
    std::sort(order.begin(), order.end());
    do {
      auto next = sums;
      for (std::size_t j = 0; j < next.size(); ++j) next[j] += order[j];
      count(at + 1, next);
    } while (std::next_permutation(order.begin(), order.end()));
  }
};

/// (k!)^(n-1), or more than `most_arrangements` where it is beyond that.
std::size_t arrangements_of(std::size_t blocks, std::size_t treatments) {
  std::size_t one = 1;
  for (std::size_t i = 2; i <= treatments && one <= most_arrangements; ++i) one *= i;
  std::size_t all = 1;
  for (std::size_t i = 1; i < blocks && all <= most_arrangements; ++i) all *= one;
  return all;
}

}  // namespace

PermutationTest permute_friedman(const Table& table, const Resampling& plan) {
  PermutationTest test;
  Concordance data(table);
  const std::size_t n = data.ranks.size();
  const std::size_t k = data.treatments();
  if (n < 2 || k < 2) {
    test.reason = k < 2 ? "fewer than two treatments" : "fewer than two complete blocks";
    return test;
  }
  if (n > few_blocks) {
    test.reason = "more than " + std::to_string(few_blocks) + " complete blocks: chi-square serves";
    return test;
  }
  std::vector<std::int64_t> sums(k, 0);
  for (const auto& block : data.ranks) {
    for (std::size_t j = 0; j < k; ++j) sums[j] += block[j];
  }
  const std::int64_t observed = extremity(sums);
  if (arrangements_of(n, k) <= most_arrangements) {
    // Naming the treatments anew changes nothing, so that the first block may stay as it is.
    Arrangements arrangements{{data.ranks.begin() + 1, data.ranks.end()}, observed};
    arrangements.count(0, data.ranks.front());
    test.exact = true;
    test.permutations = arrangements.all;
    test.p_value =
        static_cast<double>(arrangements.extreme) / static_cast<double>(arrangements.all);
    return test;
  }
  Random random(plan.seed, stream_permutations);
  std::size_t extreme = 0;
  for (std::size_t i = 0; i < plan.permutations; ++i) {
    std::fill(sums.begin(), sums.end(), 0);
    for (auto& block : data.ranks) {
      for (std::size_t j = k; j > 1; --j) std::swap(block[j - 1], block[random.below(j)]);
      for (std::size_t j = 0; j < k; ++j) sums[j] += block[j];
    }
    extreme += extremity(sums) >= observed ? 1 : 0;
  }
  test.permutations = plan.permutations;
  test.p_value = static_cast<double>(extreme + 1) / static_cast<double>(plan.permutations + 1);
  return test;
}

}  // namespace penumbra::study::statistics
