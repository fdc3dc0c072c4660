#pragma once

#include "renderer/render.h"

namespace penumbra::experiments {

/// How long a run may take, and how many frames it takes.
struct TimingBudget {
  double run_ms = 1500.0;    ///< frames that fit into this are timed
  std::uint32_t fewest = 3;  ///< frames, whatever they take, so that a spread is known ...
  std::uint32_t most = 9;
  double longest_ms = 4000.0;  ///< ... unless one takes longer: it is timed once
  double wide_spread = 0.05;   ///< times of a GPU that scatter more are taken again
};

/// Frames of one request, timed. A processor draws one frame to learn what it costs; times of a
/// GPU whose clocks fell meanwhile are taken again.
class FrameTimer {
 public:
  FrameTimer(Renderer& renderer, const TimingBudget& budget)
      : renderer_(renderer), budget_(budget) {}

  /// The request's `frames` and `settle` are chosen here. Visibility is for judges, and not drawn.
  /// `drawn`: the cost of the same picture with it, where that was drawn already.
  RenderResult time(RenderRequest request, const Cost* drawn = nullptr);

 private:
  RenderResult time_on_processor(RenderRequest& request, const Cost* drawn);
  RenderResult time_on_gpu(RenderRequest& request);

  Renderer& renderer_;
  TimingBudget budget_;
};

}  // namespace penumbra::experiments
