#include "study/statistics/analysis.h"

#include <cmath>
#include <set>

#include "study/statistics/adjust.h"
#include "study/statistics/descriptives.h"
#include "study/statistics/omnibus.h"
#include "study/statistics/pairs.h"
#include "study/statistics/posthoc.h"
#include "study/statistics/subsets.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

template <typename T>
json value_or_null(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

json number_or_null(double value) {
  return std::isnan(value) ? json(nullptr) : json(value);
}

json with_reason(json object, const std::string& reason) {
  if (!reason.empty()) object["reason"] = reason;
  return object;
}

/// One column of a table, without its missing values.
std::vector<double> column(const Table& table, std::size_t index) {
  std::vector<double> values;
  for (const auto& row : table) {
    if (!is_missing(row[index])) values.push_back(row[index]);
  }
  return values;
}

/// Descriptives of one technique: unweighted over participants' means, weighted over pages.
Descriptives describe_technique(const ParticipantTable& table, std::size_t index) {
  auto ranks = column(table.scaled_ranks, index);
  for (double& rank : ranks) rank /= table.scale;
  std::vector<double> weighted;
  std::vector<double> weights;
  for (std::size_t i = 0; i < table.weights.size(); ++i) {
    if (is_missing(table.weighted_ranks[i][index])) continue;
    weighted.push_back(table.weighted_ranks[i][index]);
    weights.push_back(table.weights[i][index]);
  }
  Descriptives result = describe(ranks, std::vector<double>(ranks.size(), 1.0));
  const Descriptives by_weight = describe(weighted, weights);
  result.weighted_mean = by_weight.weighted_mean;
  result.weighted_se = by_weight.weighted_se;
  result.effective_n = by_weight.effective_n;
  if (!result.weighted_mean && result.mean) result.reason = "all weights are zero";
  return result;
}

json technique_json(const std::string& name, const Descriptives& values) {
  const json interval = values.ci95 ? json(*values.ci95) : json(nullptr);
  return with_reason({{"technique", name},
                      {"n", values.n},
                      {"mean_rank", value_or_null(values.mean)},
                      {"weighted_mean_rank", value_or_null(values.weighted_mean)},
                      {"weighted_se", value_or_null(values.weighted_se)},
                      {"effective_n", value_or_null(values.effective_n)},
                      {"sd", value_or_null(values.sd)},
                      {"ci95", interval},
                      {"median", value_or_null(values.median)}},
                     values.reason);
}

json chi_square_json(const ChiSquareTest& test) {
  return with_reason({{"statistic", value_or_null(test.statistic)},
                      {"df", test.df},
                      {"p_value", value_or_null(test.p_value)}},
                     test.reason);
}

json friedman_json(const Table& table) {
  const Friedman result = friedman(table);
  const std::string& reason =
      result.test.reason.empty() ? result.iman_davenport.reason : result.test.reason;
  return with_reason({{"chi_square", value_or_null(result.test.statistic)},
                      {"df", result.test.df},
                      {"p_value", value_or_null(result.test.p_value)},
                      {"kendalls_w", value_or_null(result.kendalls_w)},
                      {"iman_davenport_f", value_or_null(result.iman_davenport.f)},
                      {"df1", result.iman_davenport.df1},
                      {"df2", result.iman_davenport.df2},
                      {"f_p_value", value_or_null(result.iman_davenport.p_value)}},
                     reason);
}

/// Quade weighs a block by how far its values spread. Mid-ranks of one page always spread over
/// nearly the whole scale, whatever was seen; how many steps were told apart says more, so that
/// pages enter as dense places 1, 2, 2, 3 and pooled means as they are.
json quade_json(const ParticipantTable& table) {
  Table values = table.scaled_ranks;
  if (table.single_pages) {
    for (auto& row : values) {
      std::set<double> steps;
      for (const double value : row) {
        if (!is_missing(value)) steps.insert(value);
      }
      for (double& value : row) {
        if (is_missing(value)) continue;
        value = static_cast<double>(std::distance(steps.begin(), steps.find(value)));
      }
    }
  }
  const FTest test = quade(values);
  return with_reason({{"f", value_or_null(test.f)},
                      {"df1", test.df1},
                      {"df2", test.df2},
                      {"p_value", value_or_null(test.p_value)}},
                     test.reason);
}

/// Differences a - b of the participants who saw both.
std::vector<double> differences(const Table& table, const Pair& pair, double scale) {
  std::vector<double> result;
  for (const auto& row : table) {
    if (is_missing(row[pair.a]) || is_missing(row[pair.b])) continue;
    result.push_back((row[pair.a] - row[pair.b]) / scale);
  }
  return result;
}

/// Tests of all pairs, in the order of the techniques.
class PairTests {
 public:
  PairTests(const ParticipantTable& table_, std::vector<std::string> names_)
      : table(table_), names(std::move(names_)), pairs(all_pairs(names.size())) {}

  json paired_t_json() {
    std::vector<PairedT> tests;
    const bool digits = !table.digits.empty();
    for (const Pair& pair : pairs) {
      tests.push_back(paired_t(digits ? differences(table.digits, pair, 1.0)
                                      : differences(table.scaled_ranks, pair, table.scale)));
    }
    t_bonferroni = adjust_bonferroni(p_values(tests));
    const auto holm = adjust_holm(p_values(tests));
    json list = json::array();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const PairedT& test = tests[i];
      json entry = named(i);
      entry.update({{"n", test.n},
                    {"mean_difference", value_or_null(test.mean_difference)},
                    {"t", value_or_null(test.t)},
                    {"df", test.df},
                    {"p_value", value_or_null(test.p_value)},
                    {"p_bonferroni", number_or_null(t_bonferroni[i])},
                    {"p_holm", number_or_null(holm[i])}});
      list.push_back(with_reason(entry, test.reason));
    }
    return list;
  }

  json wilcoxon_json() const {
    std::vector<SignedRank> tests;
    for (const Pair& pair : pairs) {
      tests.push_back(signed_rank(differences(table.scaled_ranks, pair, 1.0)));
    }
    const auto holm = adjust_holm(p_values(tests));
    json list = json::array();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const SignedRank& test = tests[i];
      json entry = named(i);
      entry.update({{"n", test.n},
                    {"statistic_v", value_or_null(test.v)},
                    {"p_value", value_or_null(test.p_value)},
                    {"exact", test.exact},
                    {"p_exact_conditional", value_or_null(test.p_exact_conditional)},
                    {"rank_biserial", value_or_null(test.rank_biserial)},
                    {"p_holm", number_or_null(holm[i])}});
      list.push_back(with_reason(entry, test.reason));
    }
    return list;
  }

  json sign_json() const {
    std::vector<SignTest> tests;
    for (const Pair& pair : pairs) {
      tests.push_back(sign_test(differences(table.scaled_ranks, pair, 1.0)));
    }
    const auto holm = adjust_holm(p_values(tests));
    json list = json::array();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const SignTest& test = tests[i];
      json entry = named(i);
      entry.update({{"n", test.n},
                    {"wins_a", test.wins_a},
                    {"wins_b", test.wins_b},
                    {"probability_a_better", value_or_null(test.probability_a_better)},
                    {"ci95", value_or_null(test.ci95)},
                    {"p_value", value_or_null(test.p_value)},
                    {"p_holm", number_or_null(holm[i])}});
      list.push_back(with_reason(entry, test.reason));
    }
    return list;
  }

  json adjusted_json(const std::vector<double>& p, const char* key) const {
    json list = json::array();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      json entry = named(i);
      entry[key] = number_or_null(p[i]);
      list.push_back(std::isnan(p[i]) ? with_reason(entry, "fewer than two complete participants")
                                      : entry);
    }
    return list;
  }

  /// Pairs whose paired t differs after Bonferroni; an untestable pair is not shown to differ.
  std::vector<std::vector<bool>> different(double alpha) const {
    std::vector<std::vector<bool>> result(names.size(), std::vector<bool>(names.size(), false));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const bool differs = t_bonferroni[i] < alpha;
      result[pairs[i].a][pairs[i].b] = result[pairs[i].b][pairs[i].a] = differs;
    }
    return result;
  }

 private:
  json named(std::size_t i) const { return {{"a", names[pairs[i].a]}, {"b", names[pairs[i].b]}}; }

  template <typename Test>
  static std::vector<double> p_values(const std::vector<Test>& tests) {
    std::vector<double> p;
    for (const Test& test : tests) p.push_back(test.p_value.value_or(missing));
    return p;
  }

  const ParticipantTable& table;
  std::vector<std::string> names;
  std::vector<Pair> pairs;
  std::vector<double> t_bonferroni;
};

/// Columns by weighted mean rank, then mean rank, then name; techniques without one come last.
std::vector<std::size_t> display_order(const std::vector<Descriptives>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const double last = std::numeric_limits<double>::infinity();
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(values[a].weighted_mean.value_or(last), values[a].mean.value_or(last)) <
           std::make_pair(values[b].weighted_mean.value_or(last), values[b].mean.value_or(last));
  });
  return order;
}

void reorder(const std::vector<std::size_t>& order, Table& table) {
  for (auto& row : table) {
    std::vector<double> next;
    for (const std::size_t index : order) next.push_back(row[index]);
    row = std::move(next);
  }
}

ParticipantTable reordered(const ParticipantTable& table, const std::vector<std::size_t>& order) {
  ParticipantTable result = table;
  for (Table* values :
       {&result.scaled_ranks, &result.weighted_ranks, &result.weights, &result.digits}) {
    reorder(order, *values);
  }
  for (std::size_t i = 0; i < order.size(); ++i) result.techniques[i] = table.techniques[order[i]];
  return result;
}

}  // namespace

json analyse(const SurveyData& data, const ParticipantTable& unordered, double alpha) {
  std::vector<Descriptives> values;
  for (std::size_t i = 0; i < unordered.techniques.size(); ++i) {
    values.push_back(describe_technique(unordered, i));
  }
  const auto order = display_order(values);
  const ParticipantTable table = reordered(unordered, order);
  std::vector<std::string> names;
  json techniques = json::array();
  for (std::size_t i = 0; i < order.size(); ++i) {
    names.push_back(data.techniques[table.techniques[i]]);
    techniques.push_back(technique_json(names.back(), values[order[i]]));
  }
  PairTests tests(table, names);
  json result = {
      {"participants", table.participants.size()},
      {"pages", table.pages},
      {"techniques", techniques},
      {"friedman", friedman_json(table.scaled_ranks)},
      {"quade", quade_json(table)},
      {"skillings_mack",
       chi_square_json(rank_sum_test(table.scaled_ranks, BlockWeights::skillings_mack))},
      {"paired_t", tests.paired_t_json()},
      {"paired_t_of", table.digits.empty() ? "mid_ranks" : "digits"},
      {"wilcoxon", tests.wilcoxon_json()},
      {"sign", tests.sign_json()},
      {"nemenyi", tests.adjusted_json(nemenyi(table.scaled_ranks), "p_value")},
      {"conover", tests.adjusted_json(adjust_holm(conover(table.scaled_ranks)), "p_holm")}};
  const auto subsets = maximal_cliques(tests.different(alpha));
  const auto letters = compact_letters(subsets, names.size());
  result["subsets"] = json::array();
  for (const auto& subset : subsets) {
    json members = json::array();
    for (const std::size_t member : subset) members.push_back(names[member]);
    result["subsets"].push_back(members);
  }
  result["letters"] = json::object();
  for (std::size_t i = 0; i < names.size(); ++i) result["letters"][names[i]] = letters[i];
  if (table.pages == 0) result["reason"] = "no pages";
  return result;
}

}  // namespace penumbra::study::statistics
