#include "renderer/frame/steady_times.h"

#include <cmath>

#include "renderer/frame/cost_report.h"

namespace penumbra {

void SteadyTimes::add(double device_ms, double wall_ms) {
  frames_.push_back(device_ms);
  busy_ms_ += device_ms;
  wall_ms_ += wall_ms;
}

std::size_t SteadyTimes::batch_before(std::size_t end) const {
  double sum = 0.0;
  while (end > 0 && sum < batch_ms) sum += frames_[--end];
  return end;
}

bool SteadyTimes::steady() const {
  if (busy_ms_ < least_busy_ms || frames_.size() < 2) return false;
  const std::size_t middle = batch_before(frames_.size());
  const std::size_t first = batch_before(middle);
  if (first == middle) return false;
  const auto median = [this](std::size_t begin, std::size_t end) {
    return quantile({frames_.data() + begin, frames_.data() + end}, 0.5);
  };
  const double before = median(first, middle);
  return std::abs(median(middle, frames_.size()) - before) <= tolerance * before;
}

}  // namespace penumbra
