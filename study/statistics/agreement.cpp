#include "study/statistics/agreement.h"

#include <cmath>

#include "study/statistics/table.h"

namespace penumbra::study::statistics {

namespace {

/// Leaves only the places where both lists have a value.
void drop_missing(std::vector<double>& a, std::vector<double>& b) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (is_missing(a[i]) || is_missing(b[i])) continue;
    a[kept] = a[i];
    b[kept] = b[i];
    ++kept;
  }
  a.resize(kept);
  b.resize(kept);
}

}  // namespace

std::optional<double> spearman(const std::vector<double>& a_, const std::vector<double>& b_) {
  auto a = a_;
  auto b = b_;
  drop_missing(a, b);
  const auto ranks_a = doubled_ranks(a);
  const auto ranks_b = doubled_ranks(b);
  const auto mean = static_cast<std::int64_t>(a.size() + 1);  // of doubled ranks
  std::int64_t product = 0;
  std::int64_t square_a = 0;
  std::int64_t square_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    product += (ranks_a[i] - mean) * (ranks_b[i] - mean);
    square_a += (ranks_a[i] - mean) * (ranks_a[i] - mean);
    square_b += (ranks_b[i] - mean) * (ranks_b[i] - mean);
  }
  if (square_a == 0 || square_b == 0) return std::nullopt;
  return static_cast<double>(product) /
         std::sqrt(static_cast<double>(square_a) * static_cast<double>(square_b));
}

std::optional<double> kendall_tau_b(const std::vector<double>& a_, const std::vector<double>& b_) {
  auto a = a_;
  auto b = b_;
  drop_missing(a, b);
  const auto sign = [](double x, double y) {
    return static_cast<int>(x > y) - static_cast<int>(x < y);
  };
  std::int64_t agreement = 0;
  std::int64_t untied_a = 0;
  std::int64_t untied_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int order_a = sign(a[i], a[j]);
      const int order_b = sign(b[i], b[j]);
      agreement += order_a * order_b;
      untied_a += order_a * order_a;
      untied_b += order_b * order_b;
    }
  }
  if (untied_a == 0 || untied_b == 0) return std::nullopt;
  return static_cast<double>(agreement) /
         std::sqrt(static_cast<double>(untied_a) * static_cast<double>(untied_b));
}

}  // namespace penumbra::study::statistics
