#include "study/statistics/analysis.h"

#include <cmath>

#include "study/statistics/json.h"
#include "study/statistics/omnibus.h"
#include "study/statistics/pair_tests.h"
#include "study/statistics/subsets.h"
#include "study/statistics/technique_rows.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

json chi_square_json(const ChiSquareTest& test) {
  return with_reason({{"statistic", value_or_null(test.statistic)},
                      {"df", test.df},
                      {"p_value", value_or_null(test.p_value)}},
                     test.reason);
}

json permutation_json(const PermutationTest& test) {
  return with_reason({{"p_value", value_or_null(test.p_value)},
                      {"permutations", test.permutations},
                      {"exact", test.exact}},
                     test.reason);
}

json friedman_json(const Table& table, const Resampling& resampling) {
  const Friedman result = friedman(table);
  const std::string& reason =
      result.test.reason.empty() ? result.iman_davenport.reason : result.test.reason;
  const auto interval = result.kendalls_w ? bca_of_kendalls_w(table, resampling) : std::nullopt;
  return with_reason({{"chi_square", value_or_null(result.test.statistic)},
                      {"df", result.test.df},
                      {"p_value", value_or_null(result.test.p_value)},
                      {"kendalls_w", value_or_null(result.kendalls_w)},
                      {"kendalls_w_ci95", value_or_null(interval)},
                      {"iman_davenport_f", value_or_null(result.iman_davenport.f)},
                      {"df1", result.iman_davenport.df1},
                      {"df2", result.iman_davenport.df2},
                      {"f_p_value", value_or_null(result.iman_davenport.p_value)},
                      {"permutation", permutation_json(permute_friedman(table, resampling))}},
                     reason);
}

json quade_json(const Table& table) {
  const FTest test = quade(table);
  return with_reason({{"f", value_or_null(test.f)},
                      {"df1", test.df1},
                      {"df2", test.df2},
                      {"p_value", value_or_null(test.p_value)}},
                     test.reason);
}

/// A participant's weight: of a page, or the sum over those that are pooled.
std::vector<double> block_weights(const ParticipantTable& table) {
  std::vector<double> weights;
  for (const auto& row : table.weights) {
    weights.push_back(row.empty() ? 0.0 : *std::max_element(row.begin(), row.end()));
  }
  return weights;
}

json members_json(const std::vector<std::string>& names, const std::vector<std::size_t>& members) {
  json list = json::array();
  for (const std::size_t member : members) list.push_back(names[member]);
  return list;
}

/// Subsets as maximal cliques, letters, and neighbouring runs with the pairs that they miss.
void add_subsets(const std::vector<std::string>& names,
                 const std::vector<std::vector<bool>>& different, json& result) {
  const auto subsets = maximal_cliques(different);
  const auto letters = compact_letters(subsets, names.size());
  result["subsets"] = json::array();
  for (const auto& subset : subsets) result["subsets"].push_back(members_json(names, subset));
  result["letters"] = json::object();
  for (std::size_t i = 0; i < names.size(); ++i) result["letters"][names[i]] = letters[i];
  const auto runs = neighbouring_runs(different);
  result["runs"] = json::array();
  for (const auto& [first, last] : runs) {
    std::vector<std::size_t> members;
    for (std::size_t i = first; i <= last; ++i) members.push_back(i);
    result["runs"].push_back(members_json(names, members));
  }
  result["pairs_without_run"] = json::array();
  for (const Pair& pair : all_pairs(names.size())) {
    const bool covered = std::any_of(runs.begin(), runs.end(), [&](const auto& run) {
      return run.first <= pair.a && pair.b <= run.second;
    });
    if (!different[pair.a][pair.b] && !covered) {
      result["pairs_without_run"].push_back({names[pair.a], names[pair.b]});
    }
  }
}

const char* ranks_of(const ParticipantTable& table) {
  return table.digits.empty() ? "mid_ranks" : "digits";
}

}  // namespace

json analyse(const SurveyData& data, const ParticipantTable& unordered,
             const AnalysisSettings& settings) {
  const ParticipantTable table = in_display_order(unordered);
  const auto names = technique_names(data, table);
  const PairTests tests(table, names);
  const auto complete = complete_blocks(table.scaled_ranks).size();
  json result = {
      {"participants", table.participants.size()},
      {"complete_participants", complete},
      {"pages", table.pages},
      {"tie_rate", table.ranked > 0
                       ? json(static_cast<double>(table.tied) / static_cast<double>(table.ranked))
                       : json(nullptr)},
      {"ranks_of", ranks_of(table)},
      {"techniques", techniques_json(names, table, settings.resampling)},
      {"resamples", resamples_for(settings.resampling, table.participants.size())},
      {"friedman", friedman_json(table.scaled_ranks, settings.resampling)},
      {"quade", quade_json(table.scaled_ranks)},
      {"durbin", chi_square_json(rank_sum_test(table.scaled_ranks, BlockWeights::unit))},
      {"skillings_mack",
       chi_square_json(rank_sum_test(table.scaled_ranks, BlockWeights::skillings_mack))},
      {"weighted_friedman", chi_square_json(rank_sum_test(table.scaled_ranks, BlockWeights::unit,
                                                          block_weights(table)))},
      {"family", tests.family(settings.alpha)},
      {"paired_t", tests.paired_t_list()},
      {"paired_t_of", ranks_of(table)},
      {"wilcoxon", tests.wilcoxon_list()},
      {"sign", tests.sign_list()},
      {"nemenyi", tests.nemenyi_list()},
      {"conover", tests.conover_list()}};
  add_subsets(names, tests.different(settings.alpha), result);
  if (table.pages == 0) result["reason"] = "no pages";
  return result;
}

json analyse_as_in_2007(const SurveyData& data, const ParticipantTable& unordered, double alpha) {
  const ParticipantTable table = in_display_order(unordered);
  const auto names = technique_names(data, table);
  const PairTests tests(table, names);
  json result = {{"rows", table.participants.size()},
                 {"ranks_of", ranks_of(table)},
                 {"techniques", json::array()},
                 {"paired_t", tests.paired_t_list()}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Descriptives values = describe_technique(table, i);
    result["techniques"].push_back(
        with_reason({{"technique", names[i]},
                     {"n", values.n},
                     {"mean_rank", value_or_null(values.mean)},
                     {"weighted_mean_rank", value_or_null(values.weighted_mean)}},
                    values.reason));
  }
  add_subsets(names, tests.different(alpha), result);
  return result;
}

}  // namespace penumbra::study::statistics
