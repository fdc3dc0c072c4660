#pragma once

#include <algorithm>
#include <chrono>

namespace penumbra::server {

/// The moment `seconds` from now, by the clock that no setting of the time moves. Beyond a day is a
/// day, so that no deadline overflows.
inline std::chrono::steady_clock::time_point after(double seconds) {
  using std::chrono::steady_clock;
  const std::chrono::duration<double> wait(std::clamp(seconds, 0.0, 86400.0));
  return steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(wait);
}

}  // namespace penumbra::server
