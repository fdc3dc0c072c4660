#include "study/statistics/pair_tests.h"

#include "study/statistics/adjust.h"
#include "study/statistics/json.h"
#include "study/statistics/pairs.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

/// Differences a - b of the rows that have both.
std::vector<double> differences(const Table& table, const Pair& pair, double scale) {
  std::vector<double> result;
  for (const auto& row : table) {
    if (is_missing(row[pair.a]) || is_missing(row[pair.b])) continue;
    result.push_back((row[pair.a] - row[pair.b]) / scale);
  }
  return result;
}

template <typename Test>
std::vector<double> p_values(const std::vector<Test>& tests) {
  std::vector<double> p;
  for (const Test& test : tests) p.push_back(test.p_value.value_or(missing));
  return p;
}

}  // namespace

PairTests::PairTests(const ParticipantTable& table_, std::vector<std::string> names_)
    : table(table_), names(std::move(names_)), pairs(all_pairs(names.size())) {
  make_paired_t();
}

json PairTests::named(std::size_t i) const {
  return {{"a", names[pairs[i].a]}, {"b", names[pairs[i].b]}};
}

void PairTests::add_adjusted(const std::vector<double>& p, json& list) const {
  const auto bonferroni = adjust_bonferroni(p);
  const auto holm = adjust_holm(p);
  const auto hochberg = adjust_hochberg(p);
  const auto shaffer = adjust_shaffer(p, static_cast<int>(names.size()));
  for (std::size_t i = 0; i < p.size(); ++i) {
    list[i].update({{"p_bonferroni", number_or_null(bonferroni[i])},
                    {"p_holm", number_or_null(holm[i])},
                    {"p_hochberg", number_or_null(hochberg[i])},
                    {"p_shaffer", number_or_null(shaffer[i])}});
  }
}

void PairTests::make_paired_t() {
  std::vector<PairedT> tests;
  const bool digits = !table.digits.empty();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    tests.push_back(paired_t(digits ? differences(table.digits, pairs[i], 1.0)
                                    : differences(table.scaled_ranks, pairs[i], table.scale)));
    const PairedT& test = tests.back();
    json entry = named(i);
    entry.update({{"n", test.n},
                  {"mean_difference", value_or_null(test.mean_difference)},
                  {"t", value_or_null(test.t)},
                  {"df", test.df},
                  {"p_value", value_or_null(test.p_value)},
                  {"dz", value_or_null(test.dz)},
                  {"dz_ci95", value_or_null(test.dz_ci95)}});
    paired_t_entries.push_back(with_reason(std::move(entry), test.reason));
  }
  t_bonferroni = adjust_bonferroni(p_values(tests));
  add_adjusted(p_values(tests), paired_t_entries);
}

json PairTests::wilcoxon_list() const {
  std::vector<SignedRank> tests;
  json list = json::array();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    tests.push_back(signed_rank(differences(table.scaled_ranks, pairs[i], 1.0)));
    const SignedRank& test = tests.back();
    json entry = named(i);
    entry.update({{"n", test.n},
                  {"statistic_v", value_or_null(test.v)},
                  {"p_value", value_or_null(test.p_value)},
                  {"exact", test.exact},
                  {"p_exact_conditional", value_or_null(test.p_exact_conditional)},
                  {"p_pratt", value_or_null(test.p_pratt)},
                  {"p_pratt_exact", value_or_null(test.p_pratt_exact)},
                  {"rank_biserial", value_or_null(test.rank_biserial)},
                  {"rank_biserial_ci95", value_or_null(test.rank_biserial_ci95)}});
    list.push_back(with_reason(std::move(entry), test.reason));
  }
  add_adjusted(p_values(tests), list);
  return list;
}

json PairTests::sign_list() const {
  std::vector<SignTest> tests;
  json list = json::array();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    tests.push_back(sign_test(differences(table.scaled_ranks, pairs[i], 1.0)));
    const SignTest& test = tests.back();
    json entry = named(i);
    entry.update({{"n", test.n},
                  {"wins_a", test.wins_a},
                  {"wins_b", test.wins_b},
                  {"probability_a_better", value_or_null(test.probability_a_better)},
                  {"ci95", value_or_null(test.ci95)},
                  {"p_value", value_or_null(test.p_value)}});
    list.push_back(with_reason(std::move(entry), test.reason));
  }
  add_adjusted(p_values(tests), list);
  return list;
}

json PairTests::nemenyi_list() const {
  const auto p = nemenyi(table.scaled_ranks);
  json list = json::array();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    json entry = named(i);
    entry["p_value"] = number_or_null(p[i]);
    list.push_back(with_reason(std::move(entry),
                               std::isnan(p[i]) ? "fewer than two complete participants" : ""));
  }
  return list;
}

/// Conover's p is never given unadjusted: it does not protect the family.
json PairTests::conover_list() const {
  const auto p = conover(table.scaled_ranks);
  json list = json::array();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    list.push_back(
        with_reason(named(i), std::isnan(p[i]) ? "fewer than two complete participants" : ""));
  }
  add_adjusted(p, list);
  return list;
}

json PairTests::family(double alpha) const {
  const std::size_t fewest = fewest_for_exact(pairs.size(), alpha);
  json family = {{"tests", pairs.size()}, {"alpha", alpha}, {"fewest_for_exact", fewest}};
  if (!pairs.empty()) {
    family["note"] =
        "with " + std::to_string(pairs.size()) +
        " pairs no exact sign or signed-rank test can reject after Bonferroni, nor the "
        "first of Holm's, below " +
        std::to_string(fewest) + " participants whose answers differ";
  }
  return family;
}

std::vector<std::vector<bool>> PairTests::different(double alpha) const {
  std::vector<std::vector<bool>> result(names.size(), std::vector<bool>(names.size(), false));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const bool differs = t_bonferroni[i] < alpha;
    result[pairs[i].a][pairs[i].b] = result[pairs[i].b][pairs[i].a] = differs;
  }
  return result;
}

}  // namespace penumbra::study::statistics
