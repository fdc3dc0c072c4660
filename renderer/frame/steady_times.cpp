#include "renderer/frame/steady_times.h"

#include <algorithm>
#include <cmath>

#include "renderer/frame/cost_report.h"

namespace penumbra {

void SteadyTimes::add(double device_ms, double wall_ms) {
  times_.push_back(device_ms);
  busy_ms_ += device_ms;
  wall_ms_ += wall_ms;
}

std::size_t SteadyTimes::batch_before(std::size_t end) const {
  double sum = 0.0;
  while (end > 0 && sum < batch_ms) sum += times_[--end];
  return end;
}

double SteadyTimes::median(std::size_t begin, std::size_t end) const {
  return quantile({times_.data() + begin, times_.data() + end}, 0.5);
}

double SteadyTimes::last_ms() const {
  return median(times_.size() - std::min(few, times_.size()), times_.size());
}

bool SteadyTimes::steady() const {
  if (best_ms_ > 0.0) return times_.size() >= few && last_ms() <= best_ms_ * (1.0 + tolerance);
  if (busy_ms_ < least_busy_ms || times_.size() < 2) return false;
  const std::size_t middle = batch_before(times_.size());
  const std::size_t first = batch_before(middle);
  if (first == middle) return false;
  const double before = median(first, middle);
  return std::abs(median(middle, times_.size()) - before) <= tolerance * before;
}

}  // namespace penumbra
