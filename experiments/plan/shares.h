#pragma once

#include <string>
#include <vector>

#include "experiments/engine/timing.h"

/// What the plan is worth, measured: times of a frame with all of its rules and with each left out.
namespace penumbra::experiments::plan {

struct RuleShare {
  std::string rule;         ///< as in lines of the plan
  double without_ms = 0.0;  ///< of the frame where this rule alone is left out
};

struct Shares {
  double frame_ms = 0.0;  ///< with all rules
  double none_ms = 0.0;   ///< of the technique `none`: the rest is the technique's
  bool settled = true;
  std::vector<RuleShare> rules;
};

/// Medians over `rounds`, each of which draws every variant once, so that what slows the machine
/// down for a while slows all of them. Throws as Renderer::render does.
Shares measure_shares(Renderer& renderer, const RenderRequest& request, const TimingBudget& budget,
                      int rounds = 3);

}  // namespace penumbra::experiments::plan
