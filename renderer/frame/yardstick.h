#pragma once

#include "renderer/frame/steady_times.h"
#include "renderer/render.h"
#include "renderer/vulkan/memory.h"

namespace penumbra {

/// Tells a GPU's clocks by work that takes equally long whenever they are the same, and raises them
/// by it: small frames leave a device idle between them, and its clocks down, at times that are as
/// steady as any.
class Yardstick {
 public:
  /// Works until the clocks are as high as they ever were, or steady where that is not known yet;
  /// false where they are not in time.
  bool raise_clocks(Renderer::State& state);

  /// Whether they still are.
  bool clocks_are_up(Renderer::State& state);

 private:
  /// Milliseconds that the device took for one piece of work.
  double measure(Renderer::State& state);

  vulkan::Buffer buffer_;
  double best_ms_ = 0.0;  ///< where clocks were up; 0: not known
};

}  // namespace penumbra
