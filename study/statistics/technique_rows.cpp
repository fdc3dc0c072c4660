#include "study/statistics/technique_rows.h"

#include "study/statistics/json.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

/// One column of a table, without its missing values.
std::vector<double> column(const Table& table, std::size_t index) {
  std::vector<double> values;
  for (const auto& row : table) {
    if (!is_missing(row[index])) values.push_back(row[index]);
  }
  return values;
}

/// What is averaged: digits as typed, or mean mid-ranks in units of one rank.
std::vector<double> averaged(const ParticipantTable& table, std::size_t index) {
  if (!table.digits.empty()) return column(table.digits, index);
  auto ranks = column(table.scaled_ranks, index);
  for (double& rank : ranks) rank /= table.scale;
  return ranks;
}

void reorder(const std::vector<std::size_t>& order, Table& table) {
  for (auto& row : table) {
    std::vector<double> next;
    for (const std::size_t index : order) next.push_back(row[index]);
    row = std::move(next);
  }
}

}  // namespace

Descriptives describe_technique(const ParticipantTable& table, std::size_t index) {
  const auto values = averaged(table, index);
  const Table& by_weight = table.digits.empty() ? table.weighted_ranks : table.weighted_digits;
  std::vector<double> weighted;
  std::vector<double> weights;
  for (std::size_t i = 0; i < table.weights.size(); ++i) {
    if (is_missing(by_weight[i][index])) continue;
    weighted.push_back(by_weight[i][index]);
    weights.push_back(table.weights[i][index]);
  }
  Descriptives result = describe(values, std::vector<double>(values.size(), 1.0));
  const Descriptives with_weights = describe(weighted, weights);
  result.weighted_mean = with_weights.weighted_mean;
  result.weighted_se = with_weights.weighted_se;
  result.effective_n = with_weights.effective_n;
  if (!result.weighted_mean && result.mean) result.reason = "all weights are zero";
  return result;
}

ParticipantTable in_display_order(const ParticipantTable& table) {
  std::vector<std::pair<double, double>> keys;
  const double last = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < table.techniques.size(); ++i) {
    const Descriptives values = describe_technique(table, i);
    keys.emplace_back(values.weighted_mean.value_or(last), values.mean.value_or(last));
  }
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  ParticipantTable result = table;
  for (Table* values : {&result.scaled_ranks, &result.weighted_ranks, &result.weights,
                        &result.digits, &result.weighted_digits}) {
    reorder(order, *values);
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.techniques[i] = table.techniques[order[i]];
  }
  return result;
}

std::vector<std::string> technique_names(const SurveyData& data, const ParticipantTable& table) {
  std::vector<std::string> names;
  for (const std::size_t technique : table.techniques) names.push_back(data.techniques[technique]);
  return names;
}

json techniques_json(const std::vector<std::string>& names, const ParticipantTable& table,
                     const Resampling& resampling) {
  const bool digits = !table.digits.empty();
  const double scale = digits ? 1.0 : table.scale;
  auto bootstrapped = bca_of_means(digits ? table.digits : table.scaled_ranks, resampling);
  json list = json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Descriptives values = describe_technique(table, i);
    if (bootstrapped[i])
      bootstrapped[i] = {(*bootstrapped[i])[0] / scale, (*bootstrapped[i])[1] / scale};
    json row = {{"technique", names[i]},
                {"n", values.n},
                {"mean_rank", value_or_null(values.mean)},
                {"weighted_mean_rank", value_or_null(values.weighted_mean)},
                {"weighted_se", value_or_null(values.weighted_se)},
                {"effective_n", value_or_null(values.effective_n)},
                {"sd", value_or_null(values.sd)},
                {"ci95", value_or_null(values.ci95)},
                {"bca95", value_or_null(bootstrapped[i])},
                {"median", value_or_null(values.median)}};
    if (digits) {
      double sum = 0.0;
      const auto ranks = column(table.scaled_ranks, i);
      for (const double rank : ranks) sum += rank / table.scale;
      row["mean_mid_rank"] = sum / static_cast<double>(ranks.size());
    }
    list.push_back(with_reason(std::move(row), values.reason));
  }
  return list;
}

}  // namespace penumbra::study::statistics
