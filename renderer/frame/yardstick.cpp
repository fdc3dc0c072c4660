#include "renderer/frame/yardstick.h"

#include <algorithm>
#include <chrono>

#include "renderer/frame/cost_report.h"
#include "renderer/frame/renderer_state.h"

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;

/// Of 256 lanes each: about a millisecond on a GPU of 60 TFLOP/s.
constexpr std::uint32_t groups = 4096;

}  // namespace

double Yardstick::measure(Renderer::State& state) {
  if (!buffer_)
    buffer_ = vulkan::Buffer(state.device, state.ledger, "yardstick", sizeof(float),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const vulkan::Pipeline& pipeline = state.pipelines.compute("renderer/frame/yardstick.comp");
  vulkan::Bindings bindings;
  bindings.buffer("YardstickBlock", buffer_.whole());
  state.recorder.clear_records();
  state.recorder.begin(false);
  state.recorder.pass("yardstick", [&](vulkan::Commands& commands) {
    commands.bind(pipeline, bindings);
    commands.dispatch(groups, 1, 1);
  });
  state.recorder.end();
  const double ms = device_ms(state.recorder.records());
  state.recorder.clear_records();
  return ms;
}

bool Yardstick::raise_clocks(Renderer::State& state) {
  SteadyTimes times(best_ms_);
  while (!times.steady() && !times.given_up()) {
    const Clock::time_point start = Clock::now();
    const double ms = measure(state);
    times.add(ms, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  if (!times.steady()) {
    best_ms_ = 0.0;  // it may be hot: next it need only be steady
    return false;
  }
  best_ms_ = best_ms_ > 0.0 ? std::min(best_ms_, times.last_ms()) : times.last_ms();
  return true;
}

bool Yardstick::clocks_are_up(Renderer::State& state) {
  // The first piece after a picture was read back may find the device waking.
  for (std::size_t i = 0; i < SteadyTimes::few; ++i)
    if (measure(state) <= best_ms_ * (1.0 + SteadyTimes::tolerance)) return true;
  return false;
}

}  // namespace penumbra
