#include "experiments/engine/timing.h"

#include <algorithm>

namespace penumbra::experiments {
namespace {

double frame_ms(const Cost& cost) {
  return std::max(cost.median_ms, cost.wall_median_ms);
}

std::uint32_t frames_within(const TimingBudget& budget, double each_ms) {
  const double count = each_ms > 0.0 ? budget.run_ms / each_ms : budget.most;
  return std::clamp(static_cast<std::uint32_t>(std::min<double>(count, budget.most)), budget.fewest,
                    budget.most);
}

}  // namespace

RenderResult FrameTimer::time(RenderRequest request, const Cost* drawn) {
  request.visibility = false;
  return renderer_.device().type == "cpu" ? time_on_processor(request, drawn)
                                          : time_on_gpu(request);
}

RenderResult FrameTimer::time_on_processor(RenderRequest& request, const Cost* drawn) {
  request.frames = 1;
  RenderResult once;
  if (drawn != nullptr)
    once.cost = *drawn;
  else
    once = renderer_.render(request);
  const double first_ms = frame_ms(once.cost);
  if (first_ms > budget_.longest_ms) return drawn == nullptr ? once : renderer_.render(request);
  // The first frame may have waited for compilers: it tells at most what the others take.
  request.frames = frames_within(budget_, first_ms);
  return renderer_.render(request);
}

RenderResult FrameTimer::time_on_gpu(RenderRequest& request) {
  request.settle = true;
  request.frames = budget_.fewest + 2;
  RenderResult result = renderer_.render(request);
  if (result.cost.settled && result.cost.spread <= budget_.wide_spread) return result;
  request.frames = budget_.most;
  return renderer_.render(request);
}

}  // namespace penumbra::experiments
