#pragma once

#include <vector>

#include "renderer/render.h"
#include "renderer/vulkan/commands.h"

namespace penumbra {

/// Linear interpolation between order statistics (type 7); 0 for no values.
double quantile(std::vector<double> values, double probability);

/// Device time of one frame: the sum of its passes.
double device_ms(const std::vector<vulkan::PassRecord>& records);

/// Gathers what the recorder measured, frame by frame.
class CostReport {
 public:
  /// Takes the records of one frame. `counted` frames go into the times; counters come from
  /// whichever frame had them.
  void add(const std::vector<vulkan::PassRecord>& records, double wall_ms, bool counted);
  Cost summary() const;

 private:
  struct Pass {
    std::string name;
    std::vector<double> times;
    std::array<std::uint64_t, 8> counters{};
  };
  std::vector<Pass> passes_;
  std::vector<double> frame_times_;
  std::vector<double> wall_times_;
};

}  // namespace penumbra
