#include "renderer/frame/cost_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra {

double quantile(std::vector<double> values, double probability) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double place = probability * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
}

double device_ms(const std::vector<vulkan::PassRecord>& records) {
  return std::accumulate(records.begin(), records.end(), 0.0,
                         [](double sum, const auto& record) { return sum + record.ms; });
}

void CostReport::add(const std::vector<vulkan::PassRecord>& records, double wall_ms, bool counted) {
  for (const vulkan::PassRecord& record : records) {
    auto found = std::find_if(passes_.begin(), passes_.end(),
                              [&](const Pass& pass) { return pass.name == record.name; });
    if (found == passes_.end()) {
      passes_.push_back({record.name, {}, {}});
      found = passes_.end() - 1;
    }
    if (record.counted) found->counters = record.counters;
    if (counted) found->times.push_back(record.ms);
  }
  if (!counted) return;
  frame_times_.push_back(device_ms(records));
  wall_times_.push_back(wall_ms);
}

Cost CostReport::summary() const {
  Cost cost;
  cost.median_ms = quantile(frame_times_, 0.5);
  cost.p95_ms = quantile(frame_times_, 0.95);
  if (cost.median_ms > 0.0)
    cost.spread =
        0.5 * (quantile(frame_times_, 0.75) - quantile(frame_times_, 0.25)) / cost.median_ms;
  cost.frames = static_cast<std::uint32_t>(frame_times_.size());
  cost.wall_median_ms = quantile(wall_times_, 0.5);
  cost.timing_ms = std::accumulate(wall_times_.begin(), wall_times_.end(), 0.0);
  for (const Pass& pass : passes_) {
    PassCost out;
    out.name = pass.name;
    out.median_ms = quantile(pass.times, 0.5);
    const auto& c = pass.counters;
    out.vertices = c[0];
    out.primitives = c[1];
    out.vertex_invocations = c[2];
    out.geometry_invocations = c[3];
    out.geometry_primitives = c[4];
    out.clipped_primitives = c[5];
    out.fragment_invocations = c[6];
    out.compute_invocations = c[7];
    cost.passes.push_back(out);
  }
  return cost;
}

}  // namespace penumbra
