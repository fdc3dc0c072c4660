#include "study/statistics/worths.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "study/statistics/json.h"

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

json fit_json(const PlackettLuce& fit, const std::vector<std::string>& techniques) {
  json result = {
      {"worths", json::array()}, {"tie_parameter", nullptr}, {"log_likelihood", nullptr}};
  if (!fit.reason.empty()) {
    result["reason"] = fit.reason;
    for (const auto& group : fit.groups) {
      json names = json::array();
      for (const std::size_t item : group) names.push_back(techniques[item]);
      result["groups"].push_back(names);
    }
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

/// Bradley-Terry as a check: every pair on a page is one comparison, ties are half a win each. Its
/// errors take comparisons of one page for independent, which they are not; only worths compare.
json bradley_terry_json(const Table& wins, const std::vector<std::string>& techniques) {
  std::vector<Ranking> comparisons;
  for (std::size_t i = 0; i < wins.size(); ++i) {
    for (std::size_t j = 0; j < wins.size(); ++j) {
      if (wins[i][j] > 0.0) comparisons.push_back({{{i}, {j}}, wins[i][j], 0});
    }
  }
  const PlackettLuce fit = fit_plackett_luce(comparisons, techniques.size());
  json result = {{"worths", json::array()}};
  if (!fit.reason.empty()) return with_reason(std::move(result), fit.reason);
  for (std::size_t i = 0; i < techniques.size(); ++i) {
    result["worths"].push_back({{"technique", techniques[i]}, {"log_worth", fit.log_worths[i]}});
  }
  return result;
}

}  // namespace

std::vector<Ranking> rankings_of(const SurveyData& data, const Selection& selection,
                                 std::optional<std::size_t> scene,
                                 const std::vector<std::string>& techniques) {
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
  return rankings;
}

Table wins_of(const std::vector<Ranking>& rankings, std::size_t items) {
  Table wins(items, std::vector<double>(items, 0.0));
  for (const Ranking& ranking : rankings) {
    for (std::size_t place = 0; place < ranking.places.size(); ++place) {
      for (const std::size_t winner : ranking.places[place]) {
        for (const std::size_t equal : ranking.places[place]) {
          if (equal != winner) wins[winner][equal] += 0.5 * ranking.weight;
        }
        for (std::size_t later = place + 1; later < ranking.places.size(); ++later) {
          for (const std::size_t loser : ranking.places[later])
            wins[winner][loser] += ranking.weight;
        }
      }
    }
  }
  return wins;
}

json worths_json(const std::vector<Ranking>& rankings, const std::vector<std::string>& techniques) {
  json result = fit_json(fit_plackett_luce(rankings, techniques.size()), techniques);
  result["regularised"] =
      fit_json(fit_plackett_luce(rankings, techniques.size(), default_pseudo_rankings), techniques);
  result["regularised"]["pseudo_rankings"] = default_pseudo_rankings;
  result["bradley_terry"] = bradley_terry_json(wins_of(rankings, techniques.size()), techniques);
  return result;
}

}  // namespace penumbra::study::statistics
