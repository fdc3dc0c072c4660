#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/recommend/measured.h"

namespace penumbra::experiments::recommend {

/// Budgets that are tried, as multiples of the frame without shadows.
inline constexpr std::array<double, 5> tried_budgets{1.5, 2.0, 3.0, 5.0, 10.0};

/// A recommendation for a scene that the model never saw, beside what a search of everything finds.
struct Case {
  std::string scene;
  int size = 0;
  double budget = 0.0;  ///< times `none`
  std::string candidate;
  std::string fastest;        ///< of those with no more error than the candidate's
  double time_regret = 0.0;   ///< how much more time than `fastest`, as a share
  double error_regret = 0.0;  ///< error above the least that fits, as a share of `none`'s error
  std::string unprobed;       ///< what the model takes without any probe
  double unprobed_time = 0.0;
  double unprobed_error = 0.0;
  bool fits = false;  ///< the budget
  std::size_t probes = 0;
};

/// A mean over scenes with the interval that holds it in 95 of 100 draws of scenes.
struct Estimate {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};

struct Evaluation {
  std::vector<Case> cases;
  Estimate time_regret;
  Estimate error_regret;
  Estimate unprobed_time;
  Estimate unprobed_error;
  double fitting = 0.0;  ///< share of cases whose budget is kept
  double mean_probes = 0.0;
  std::size_t candidates = 0;
};

/// Leaves each scene out in turn, at all its sizes. Budgets that nothing keeps are no case. Throws
/// bad_value (field "from") for fewer than three scenes: there is nothing to learn from.
Evaluation evaluate(const Measured& measured);

nlohmann::json to_json(const Evaluation& evaluation);

/// The mean of each scene's mean, and its interval by drawing scenes anew 2000 times, seeded.
Estimate mean_over_scenes(const std::vector<std::pair<std::string, double>>& values);

}  // namespace penumbra::experiments::recommend
