#include "experiments/plan/shares.h"

#include <algorithm>
#include <utility>

#include "experiments/engine/engine.h"

namespace penumbra::experiments::plan {
namespace {

double middle(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace

Shares measure_shares(Renderer& renderer, const RenderRequest& request, const TimingBudget& budget,
                      int rounds) {
  std::vector<RenderRequest> variants{request, request};
  variants[1].technique = &technique_of_family("none");
  variants[1].parameters = {};
  for (const auto& [name, rule] : lossless_rules) {
    variants.push_back(request);
    variants.back().rules.*rule = false;
  }
  FrameTimer timer(renderer, budget);
  Shares shares;
  std::vector<std::vector<double>> times(variants.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const Cost cost = timer.time(variants[i]).cost;
      times[i].push_back(cost.median_ms);
      shares.settled = shares.settled && cost.settled;
    }
  shares.frame_ms = middle(times[0]);
  shares.none_ms = middle(times[1]);
  for (std::size_t i = 0; i < std::size(lossless_rules); ++i)
    shares.rules.push_back({lossless_rules[i].first, middle(times[i + 2])});
  return shares;
}

}  // namespace penumbra::experiments::plan
