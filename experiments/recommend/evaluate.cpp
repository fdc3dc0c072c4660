#include "experiments/recommend/evaluate.h"

#include <algorithm>
#include <map>
#include <random>

#include "experiments/recommend/model.h"
#include "renderer/error.h"

namespace penumbra::experiments::recommend {
namespace {

using nlohmann::json;

constexpr int draws = 2000;  ///< of scenes, for an interval

struct Regrets {
  double time = 0.0;
  double error = 0.0;
  std::string fastest;
};

/// What a candidate loses against a search of everything on the scene.
Regrets regrets_of(const MeasuredScene& scene, const std::string& candidate, const Budget& budget) {
  const Known& mine = scene.candidates.at(candidate);
  Regrets regrets;
  double fastest = mine.ms, least = mine.error;
  regrets.fastest = candidate;
  for (const auto& [name, known] : scene.candidates) {
    if (known.error <= mine.error && known.ms < fastest) {
      fastest = known.ms;
      regrets.fastest = name;
    }
    if (budget.holds(known)) least = std::min(least, known.error);
  }
  regrets.time = mine.ms / fastest - 1.0;
  // A candidate that breaks the budget may have less error than any that keeps it.
  regrets.error = std::max(0.0, mine.error - least) / scene.none.error;
  return regrets;
}

/// What the model says before anything of the scene is measured.
std::string unprobed_choice(const Measured& others, const MeasuredScene& scene,
                            const Budget& budget) {
  Probes expected;
  for (const auto& [name, known] : scene.candidates)
    if (const auto what = guess(others, scene.none, {}, name))
      expected[name] = {what->error, what->ms, what->bytes};
  return best_of(expected, budget, ModelConstants{}.tie);
}

std::optional<Case> judge(const Measured& others, const MeasuredScene& scene, double times) {
  const Budget budget{times * scene.none.ms, std::nullopt};
  std::vector<std::string> names;
  bool any = false;
  for (const auto& [name, known] : scene.candidates) {
    names.push_back(name);
    any = any || budget.holds(known);
  }
  if (!any) return std::nullopt;
  const Choice choice = choose(others, names, scene.none, budget, [&](const std::string& name) {
    return std::optional<Known>(scene.candidates.at(name));
  });
  const std::string unprobed = unprobed_choice(others, scene, budget);
  if (choice.candidate.empty() || unprobed.empty()) return std::nullopt;
  const Regrets mine = regrets_of(scene, choice.candidate, budget);
  const Regrets blind = regrets_of(scene, unprobed, budget);
  Case found;
  found.scene = scene.scene;
  found.size = scene.size;
  found.budget = times;
  found.candidate = choice.candidate;
  found.fastest = mine.fastest;
  found.time_regret = mine.time;
  found.error_regret = mine.error;
  found.unprobed = unprobed;
  found.unprobed_time = blind.time;
  found.unprobed_error = blind.error;
  found.fits = choice.fits;
  found.probes = choice.probed.size();
  return found;
}

json estimate_json(const Estimate& estimate) {
  return {{"mean", estimate.mean}, {"ci95", {estimate.low, estimate.high}}};
}

}  // namespace

Estimate mean_over_scenes(const std::vector<std::pair<std::string, double>>& values) {
  std::map<std::string, std::pair<double, int>> sums;
  for (const auto& [scene, value] : values) {
    sums[scene].first += value;
    ++sums[scene].second;
  }
  std::vector<double> means;
  for (const auto& [scene, sum] : sums) means.push_back(sum.first / sum.second);
  if (means.empty()) return {};
  const auto mean_of = [](const std::vector<double>& list) {
    double sum = 0.0;
    for (const double value : list) sum += value;
    return sum / static_cast<double>(list.size());
  };
  std::mt19937_64 random(1);
  std::vector<double> drawn;
  for (int i = 0; i < draws; ++i) {
    std::vector<double> sample;
    for (std::size_t k = 0; k < means.size(); ++k) sample.push_back(means[random() % means.size()]);
    drawn.push_back(mean_of(sample));
  }
  std::sort(drawn.begin(), drawn.end());
  return {mean_of(means), drawn[draws / 40], drawn[draws - 1 - draws / 40]};
}

Evaluation evaluate(const Measured& measured) {
  std::vector<std::string> scenes;
  for (const MeasuredScene& scene : measured.scenes)
    if (std::find(scenes.begin(), scenes.end(), scene.scene) == scenes.end())
      scenes.push_back(scene.scene);
  if (scenes.size() < 3)
    throw bad_value("from", "the results hold " + std::to_string(scenes.size()) +
                                " judged scenes: an evaluation needs three");
  Evaluation result;
  result.candidates = measured.candidates().size();
  for (const MeasuredScene& scene : measured.scenes) {
    Measured others;
    for (const MeasuredScene& other : measured.scenes)
      if (other.scene != scene.scene) others.scenes.push_back(other);
    for (const double times : tried_budgets)
      if (const auto found = judge(others, scene, times)) result.cases.push_back(*found);
  }
  const auto estimate = [&](double Case::*value) {
    std::vector<std::pair<std::string, double>> values;
    for (const Case& each : result.cases) values.emplace_back(each.scene, each.*value);
    return mean_over_scenes(values);
  };
  result.time_regret = estimate(&Case::time_regret);
  result.error_regret = estimate(&Case::error_regret);
  result.unprobed_time = estimate(&Case::unprobed_time);
  result.unprobed_error = estimate(&Case::unprobed_error);
  for (const Case& each : result.cases) {
    const double share = 1.0 / static_cast<double>(result.cases.size());
    result.fitting += each.fits ? share : 0.0;
    result.mean_probes += share * static_cast<double>(each.probes);
  }
  return result;
}

json to_json(const Evaluation& evaluation) {
  json cases = json::array();
  for (const Case& each : evaluation.cases)
    cases.push_back({{"scene", each.scene},
                     {"size", each.size},
                     {"budget_times_none", each.budget},
                     {"recommended", each.candidate},
                     {"fastest_at_equal_error", each.fastest},
                     {"time_regret", each.time_regret},
                     {"error_regret", each.error_regret},
                     {"fits", each.fits},
                     {"probes", each.probes}});
  return {{"time_regret", estimate_json(evaluation.time_regret)},
          {"error_regret", estimate_json(evaluation.error_regret)},
          {"without_probes",
           {{"time_regret", estimate_json(evaluation.unprobed_time)},
            {"error_regret", estimate_json(evaluation.unprobed_error)}}},
          {"budgets_kept", evaluation.fitting},
          {"mean_probes", evaluation.mean_probes},
          {"candidates", evaluation.candidates},
          {"cases", cases}};
}

}  // namespace penumbra::experiments::recommend
