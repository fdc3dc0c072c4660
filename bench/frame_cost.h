#pragma once

#include <ctime>

#include "renderer/render.h"

namespace penumbra::bench {

/// Milliseconds that the threads of this process have worked. They hardly move with what else the
/// machine does.
inline double worked_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

struct FrameCost {
  double worked_ms = 0.0;  ///< processor time a frame
  Cost cost;
};

/// Draws the request with few frames and with many: what is left of their difference is frames
/// alone. Its pipelines should have been made before.
inline FrameCost frame_cost(Renderer& renderer, RenderRequest request, std::uint32_t frames) {
  const double start = worked_ms();
  request.settle = true;
  request.frames = 2;
  renderer.render(request);
  const double between = worked_ms();
  request.frames = 2 + frames;
  Cost cost = renderer.render(request).cost;
  return {(worked_ms() - between - (between - start)) / frames, std::move(cost)};
}

}  // namespace penumbra::bench
