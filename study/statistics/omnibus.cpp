#include "study/statistics/omnibus.h"

#include <Eigen/Dense>
#include <cmath>

#include "study/statistics/distributions.h"

namespace penumbra::study::statistics {

namespace {

/// The values of a block and the columns they are in.
struct Block {
  std::vector<std::size_t> columns;
  std::vector<double> ranks;
};

Block rank_block(const std::vector<double>& row) {
  Block block;
  std::vector<double> values;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (is_missing(row[i])) continue;
    block.columns.push_back(i);
    values.push_back(row[i]);
  }
  for (const std::int64_t rank : doubled_ranks(values)) {
    block.ranks.push_back(0.5 * static_cast<double>(rank));
  }
  return block;
}

struct Sums {
  Eigen::VectorXd ranks;
  Eigen::MatrixXd covariance;
  int blocks = 0;
};

/// Adds a block of n ranks: centred ranks to the sums; to the covariance that of a random
/// permutation, s^2 (I - 1/n), where s^2 is the variance of the block's own mid-ranks.
void add_block(const Block& block, double weight, Sums& sums) {
  const auto n = static_cast<double>(block.ranks.size());
  const double mean = 0.5 * (n + 1.0);
  double variance = 0.0;
  for (const double rank : block.ranks) variance += (rank - mean) * (rank - mean) / (n - 1.0);
  for (std::size_t i = 0; i < block.columns.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(block.columns[i]);
    sums.ranks(row) += weight * (block.ranks[i] - mean);
    for (std::size_t j = 0; j < block.columns.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(block.columns[j]);
      sums.covariance(row, column) += weight * weight * variance * ((i == j ? 1.0 : 0.0) - 1.0 / n);
    }
  }
  ++sums.blocks;
}

ChiSquareTest quadratic_form(const Sums& sums) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(sums.covariance);
  const double largest = solver.eigenvalues().size() > 0 ? solver.eigenvalues().maxCoeff() : 0.0;
  ChiSquareTest test;
  if (!(largest > 0.0)) {
    test.reason = "every block is tied throughout";
    return test;
  }
  double statistic = 0.0;
  for (Eigen::Index i = 0; i < solver.eigenvalues().size(); ++i) {
    const double eigenvalue = solver.eigenvalues()(i);
    if (eigenvalue <= 1e-10 * largest) continue;  // the pseudo-inverse leaves the null space out
    const double part = solver.eigenvectors().col(i).dot(sums.ranks);
    statistic += part * part / eigenvalue;
    ++test.df;
  }
  test.statistic = statistic;
  test.p_value = chi_square_tail(statistic, test.df);
  return test;
}

/// F of a statistic whose denominator may vanish when all blocks agree.
FTest f_test(double numerator, double denominator, int df1, int df2) {
  FTest test;
  test.df1 = df1;
  test.df2 = df2;
  if (denominator <= 1e-12 * std::abs(numerator)) {
    if (numerator <= 0.0) {
      test.reason = "every block is tied throughout";
      return test;
    }
    test.p_value = 0.0;
    test.reason = "all blocks agree: F is unbounded";
    return test;
  }
  test.f = numerator / denominator;
  test.p_value = f_tail(*test.f, df1, df2);
  return test;
}

std::string too_small(std::size_t blocks, std::size_t treatments) {
  if (treatments < 2) return "fewer than two treatments";
  if (blocks < 2) return "fewer than two complete blocks";
  return {};
}

}  // namespace

ChiSquareTest rank_sum_test(const Table& table, BlockWeights kind,
                            const std::vector<double>& weights) {
  const std::size_t columns = table.empty() ? 0 : table.front().size();
  const auto size = static_cast<Eigen::Index>(columns);
  Sums sums{Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size), 0};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Block block = rank_block(table[i]);
    double weight = weights.empty() ? 1.0 : weights.at(i);
    if (block.ranks.size() < 2 || !(weight > 0.0)) continue;
    if (kind == BlockWeights::skillings_mack) {
      weight *= std::sqrt(12.0 / (static_cast<double>(block.ranks.size()) + 1.0));
    }
    add_block(block, weight, sums);
  }
  if (sums.blocks == 0) {
    ChiSquareTest test;
    test.reason = "no block holds two values";
    return test;
  }
  return quadratic_form(sums);
}

Friedman friedman(const Table& table) {
  Friedman result;
  result.test = rank_sum_test(table, BlockWeights::unit);
  const Table complete = complete_blocks(table);
  if (complete.size() != table.size()) {
    result.iman_davenport.reason = "some blocks are incomplete";
    return result;
  }
  const std::size_t treatments = complete.empty() ? 0 : complete.front().size();
  if (!result.test.statistic) {
    result.iman_davenport.reason = result.test.reason;
    return result;
  }
  const auto n = static_cast<double>(complete.size());
  const auto k = static_cast<double>(treatments);
  const double most = n * (k - 1.0);
  result.kendalls_w = std::min(1.0, *result.test.statistic / most);
  result.iman_davenport.reason = too_small(complete.size(), treatments);
  if (!result.iman_davenport.reason.empty()) return result;
  result.iman_davenport =
      f_test((n - 1.0) * *result.test.statistic, most - *result.test.statistic,
             static_cast<int>(k) - 1, (static_cast<int>(k) - 1) * (static_cast<int>(n) - 1));
  return result;
}

FTest quade(const Table& table) {
  const Table complete = complete_blocks(table);
  const std::size_t k = complete.empty() ? 0 : complete.front().size();
  FTest test;
  test.reason = too_small(complete.size(), k);
  if (!test.reason.empty()) return test;
  std::vector<double> ranges;
  for (const auto& row : complete) {
    const auto [low, high] = std::minmax_element(row.begin(), row.end());
    ranges.push_back(*high - *low);
  }
  const auto block_ranks = doubled_ranks(ranges);
  std::vector<double> sums(k, 0.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < complete.size(); ++i) {
    const auto ranks = doubled_ranks(complete[i]);
    for (std::size_t j = 0; j < k; ++j) {
      const double centred = 0.5 * static_cast<double>(ranks[j] - static_cast<std::int64_t>(k) - 1);
      const double score = 0.5 * static_cast<double>(block_ranks[i]) * centred;
      sums[j] += score;
      squares += score * score;
    }
  }
  const auto n = static_cast<double>(complete.size());
  double between = 0.0;
  for (const double sum : sums) between += sum * sum / n;
  return f_test((n - 1.0) * between, squares - between, static_cast<int>(k) - 1,
                (static_cast<int>(k) - 1) * (static_cast<int>(n) - 1));
}

Table complete_blocks(const Table& table) {
  Table complete;
  for (const auto& row : table) {
    if (std::none_of(row.begin(), row.end(), is_missing)) complete.push_back(row);
  }
  return complete;
}

std::vector<double> rank_sums(const Table& table) {
  std::vector<double> sums(table.empty() ? 0 : table.front().size(), 0.0);
  for (const auto& row : complete_blocks(table)) {
    const auto ranks = doubled_ranks(row);
    for (std::size_t i = 0; i < ranks.size(); ++i) sums[i] += 0.5 * static_cast<double>(ranks[i]);
  }
  return sums;
}

}  // namespace penumbra::study::statistics
