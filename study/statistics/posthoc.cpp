#include "study/statistics/posthoc.h"

#include <cmath>

#include "study/statistics/distributions.h"
#include "study/statistics/omnibus.h"

namespace penumbra::study::statistics {

std::vector<Pair> all_pairs(std::size_t treatments) {
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < treatments; ++a) {
    for (std::size_t b = a + 1; b < treatments; ++b) pairs.push_back({a, b});
  }
  return pairs;
}

std::vector<double> nemenyi(const Table& table) {
  const Table complete = complete_blocks(table);
  const std::size_t k = table.empty() ? 0 : table.front().size();
  const auto pairs = all_pairs(k);
  if (complete.size() < 2) return std::vector<double>(pairs.size(), missing);
  const auto sums = rank_sums(complete);
  const auto n = static_cast<double>(complete.size());
  const auto count = static_cast<double>(k);
  const double error = std::sqrt(count * (count + 1.0) / (12.0 * n));
  std::vector<double> p;
  for (const Pair& pair : pairs) {
    const double q = std::abs(sums[pair.a] - sums[pair.b]) / n / error;
    p.push_back(studentized_range_tail(q, static_cast<int>(k)));
  }
  return p;
}

double nemenyi_critical_difference(std::size_t blocks, int treatments, double alpha) {
  const double q = studentized_range_quantile(alpha, treatments) / std::sqrt(2.0);
  return q * std::sqrt(treatments * (treatments + 1.0) / (6.0 * static_cast<double>(blocks)));
}

std::vector<double> conover(const Table& table) {
  const Table complete = complete_blocks(table);
  const std::size_t treatments = table.empty() ? 0 : table.front().size();
  const auto pairs = all_pairs(treatments);
  if (complete.size() < 2) return std::vector<double>(pairs.size(), missing);
  const auto n = static_cast<double>(complete.size());
  const auto k = static_cast<double>(treatments);
  // Sums of squares in quarters of doubled ranks: integers, so that "no variance left" is exact.
  std::int64_t squares = 0;
  std::vector<std::int64_t> sums(treatments, 0);
  for (const auto& row : complete) {
    const auto ranks = doubled_ranks(row);
    for (std::size_t i = 0; i < treatments; ++i) {
      squares += ranks[i] * ranks[i];
      sums[i] += ranks[i];
    }
  }
  std::int64_t sum_squares = 0;
  for (const std::int64_t sum : sums) sum_squares += sum * sum;
  const double left =
      static_cast<double>(static_cast<std::int64_t>(complete.size()) * squares - sum_squares) / 4.0;
  const double df = (n - 1.0) * (k - 1.0);
  std::vector<double> p;
  for (const Pair& pair : pairs) {
    const double difference = 0.5 * static_cast<double>(std::abs(sums[pair.a] - sums[pair.b]));
    if (left <= 0.0) {
      p.push_back(difference > 0.0 ? 0.0 : 1.0);
      continue;
    }
    p.push_back(t_two_sided(difference / std::sqrt(2.0 * left / df), df));
  }
  return p;
}

double exact_rank_sum_difference(int difference, int treatments, int blocks) {
  // One block: d = r_i - r_j takes each value in +-(1..k-1) with probability (k - |d|) / (k (k-1)).
  const int reach = treatments - 1;
  const double pairs = static_cast<double>(treatments) * reach;
  std::vector<double> sum{1.0};  // index is the sum plus blocks-so-far * reach
  for (int block = 0; block < blocks; ++block) {
    std::vector<double> next(sum.size() + 2 * static_cast<std::size_t>(reach), 0.0);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      for (int d = -reach; d <= reach; ++d) {
        if (d == 0) continue;
        next[i + static_cast<std::size_t>(d + reach)] +=
            sum[i] * (treatments - std::abs(d)) / pairs;
      }
    }
    sum = std::move(next);
  }
  double p = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (std::abs(static_cast<int>(i) - blocks * reach) >= difference) p += sum[i];
  }
  return std::min(1.0, p);
}

}  // namespace penumbra::study::statistics
