#include "renderer/frame/steady_times.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace penumbra {
namespace {

struct Outcome {
  bool steady = false;
  int frames = 0;
  double busy_ms = 0.0;
  double last_ms = 0.0;
};

/// Pieces of work of `ms(device time so far)` until the times are steady or given up; each takes
/// `cpu_ms` of the CPU besides.
Outcome wait(const std::function<double(double)>& ms, double cpu_ms = 0.0, double best_ms = 0.0) {
  SteadyTimes times(best_ms);
  Outcome outcome;
  while (!times.steady() && !times.given_up()) {
    outcome.last_ms = ms(outcome.busy_ms);
    outcome.busy_ms += outcome.last_ms;
    ++outcome.frames;
    times.add(outcome.last_ms, outcome.last_ms + cpu_ms);
  }
  outcome.steady = times.steady();
  return outcome;
}

TEST(SteadyTimes, waits_until_a_device_that_idled_has_its_clocks_back) {
  // As an H200 was seen: steps of clocks, by device time until which they hold.
  const std::vector<std::vector<std::pair<double, double>>> ramps{
      {},
      {{155, 22.57}, {159, 11.49}},
      {{136, 22.55}, {148, 19.51}, {336, 12.23}, {340, 8.89}},
      {{91, 22.65}, {289, 22.58}, {290, 5.83}},
  };
  for (const auto& ramp : ramps) {
    const Outcome outcome = wait([&](double busy_ms) {
      for (const auto& [until, ms] : ramp)
        if (busy_ms < until) return ms;
      return 4.0;
    });
    EXPECT_TRUE(outcome.steady);
    EXPECT_GE(outcome.busy_ms, SteadyTimes::least_busy_ms);
    EXPECT_LE(outcome.busy_ms, SteadyTimes::least_busy_ms + 2 * SteadyTimes::batch_ms);
    EXPECT_DOUBLE_EQ(outcome.last_ms, 4.0);
  }
}

TEST(SteadyTimes, does_not_believe_times_that_still_fall) {
  const Outcome outcome =
      wait([](double busy_ms) { return 3.8 * (1.0 + 4.7 * std::exp(-busy_ms / 250.0)); });
  EXPECT_TRUE(outcome.steady);
  EXPECT_LT(outcome.last_ms, 3.8 * 1.05);
}

TEST(SteadyTimes, gives_up_on_times_that_never_agree) {
  int frame = 0;
  const Outcome outcome = wait([&](double) { return 4.0 + 0.2 * (frame++); });
  EXPECT_FALSE(outcome.steady);
  frame = 0;
  const Outcome slow = wait([&](double) { return 4.0 + 0.2 * (frame++); }, 100.0);
  EXPECT_FALSE(slow.steady);
  EXPECT_LE(slow.frames, 30);
}

TEST(SteadyTimes, know_at_once_that_clocks_are_up_where_it_is_known_what_they_are) {
  const Outcome up = wait([](double) { return 1.004; }, 0.0, 1.0);
  EXPECT_TRUE(up.steady);
  EXPECT_EQ(up.frames, 3);
  // A level below the best, however steady, is not believed.
  const Outcome rises = wait([](double busy_ms) { return busy_ms < 900 ? 1.8 : 1.0; }, 0.0, 1.0);
  EXPECT_TRUE(rises.steady);
  EXPECT_GE(rises.busy_ms, 900.0);
  EXPECT_FALSE(wait([](double) { return 1.1; }, 0.0, 1.0).steady);
}

TEST(SteadyTimes, believes_two_equal_frames_that_take_long) {
  const Outcome outcome = wait([](double) { return 1000.0; });
  EXPECT_TRUE(outcome.steady);
  EXPECT_EQ(outcome.frames, 2);
}

}  // namespace
}  // namespace penumbra
