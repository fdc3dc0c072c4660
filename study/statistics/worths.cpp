#include "study/statistics/worths.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "study/statistics/plackett_luce.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

/// The page's pictures by rank; `index` maps the survey's techniques to those fitted.
Ranking ranking_of(const PageAnswer& page, bool turned,
                   const std::map<std::size_t, std::size_t>& index) {
  std::map<double, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < page.doubled_ranks.size(); ++i) {
    if (is_missing(page.doubled_ranks[i])) continue;
    places[turned ? -page.doubled_ranks[i] : page.doubled_ranks[i]].push_back(index.at(i));
  }
  Ranking ranking;
  ranking.cluster = page.participant;
  for (const auto& [rank, items] : places) ranking.places.push_back(items);
  return ranking;
}

json worth_json(const PlackettLuce& fit, const std::string& technique, std::size_t i) {
  constexpr double normal_975 = 1.959963984540054;
  const double error = std::sqrt(fit.covariance[i][i]);
  const bool quasi = !fit.quasi_errors.empty();
  return {
      {"technique", technique},
      {"log_worth", fit.log_worths[i]},
      {"se", error},
      {"robust_se", std::sqrt(std::max(0.0, fit.robust_covariance[i][i]))},
      {"quasi_se", quasi ? json(fit.quasi_errors[i]) : json(nullptr)},
      {"ci95", {fit.log_worths[i] - normal_975 * error, fit.log_worths[i] + normal_975 * error}}};
}

}  // namespace

json worths_json(const SurveyData& data, const Selection& selection,
                 std::optional<std::size_t> scene, const std::vector<std::string>& techniques) {
  std::map<std::size_t, std::size_t> index;
  for (std::size_t i = 0; i < techniques.size(); ++i) {
    const auto at = std::lower_bound(data.techniques.begin(), data.techniques.end(), techniques[i]);
    index[static_cast<std::size_t>(at - data.techniques.begin())] = i;
  }
  std::vector<Ranking> rankings;
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    const PageAnswer& page = data.pages[i];
    if (!selection.used[i] || page.repeat > 0 || (scene && page.scene != *scene)) continue;
    rankings.push_back(ranking_of(page, selection.turned[i], index));
  }
  const PlackettLuce fit = fit_plackett_luce(rankings, techniques.size());
  json result = {
      {"worths", json::array()}, {"tie_parameter", nullptr}, {"log_likelihood", nullptr}};
  if (!fit.reason.empty()) {
    result["reason"] = fit.reason;
    return result;
  }
  for (std::size_t i = 0; i < techniques.size(); ++i) {
    result["worths"].push_back(worth_json(fit, techniques[i], i));
  }
  result["tie_parameters"] = json::object();
  for (const auto& [order, value] : fit.log_ties) {
    result["tie_parameters"][std::to_string(order)] = std::exp(value);
  }
  if (fit.log_ties.contains(2)) result["tie_parameter"] = std::exp(fit.log_ties.at(2));
  result["log_likelihood"] = fit.log_likelihood;
  return result;
}

}  // namespace penumbra::study::statistics
