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

/// Sums over strata for one coefficient: products, and squares of either side.
struct Products {
  std::int64_t both = 0;
  std::int64_t a = 0;
  std::int64_t b = 0;

  void add(std::int64_t x, std::int64_t y) {
    both += x * y;
    a += x * x;
    b += y * y;
  }
  std::optional<double> coefficient() const {
    if (a == 0 || b == 0) return std::nullopt;
    return static_cast<double>(both) / std::sqrt(static_cast<double>(a) * static_cast<double>(b));
  }
};

void add_ranks(const RankedList& list, Products& products) {
  const auto ranks_a = doubled_ranks(list.a);
  const auto ranks_b = doubled_ranks(list.b);
  const auto mean = static_cast<std::int64_t>(list.a.size() + 1);  // of doubled ranks
  for (std::size_t i = 0; i < ranks_a.size(); ++i) {
    products.add(ranks_a[i] - mean, ranks_b[i] - mean);
  }
}

void add_pairs(const RankedList& list, Products& products) {
  const auto sign = [](double x, double y) {
    return static_cast<std::int64_t>(x > y) - static_cast<std::int64_t>(x < y);
  };
  for (std::size_t i = 0; i < list.a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      products.add(sign(list.a[i], list.a[j]), sign(list.b[i], list.b[j]));
    }
  }
}

RankedList complete(const std::vector<double>& a, const std::vector<double>& b) {
  RankedList list{a, b};
  drop_missing(list.a, list.b);
  return list;
}

}  // namespace

std::optional<double> spearman(const std::vector<double>& a, const std::vector<double>& b) {
  Products products;
  add_ranks(complete(a, b), products);
  return products.coefficient();
}

std::optional<double> kendall_tau_b(const std::vector<double>& a, const std::vector<double>& b) {
  Products products;
  add_pairs(complete(a, b), products);
  return products.coefficient();
}

RankCorrelation correlate_within(const std::vector<RankedList>& strata) {
  Products ranks;
  Products pairs;
  for (const RankedList& stratum : strata) {
    const RankedList list = complete(stratum.a, stratum.b);
    add_ranks(list, ranks);
    add_pairs(list, pairs);
  }
  return {ranks.coefficient(), pairs.coefficient()};
}

}  // namespace penumbra::study::statistics
