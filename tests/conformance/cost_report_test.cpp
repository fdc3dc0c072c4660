#include "renderer/frame/cost_report.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

vulkan::PassRecord record(const std::string& name, double ms) {
  vulkan::PassRecord made;
  made.name = name;
  made.ms = ms;
  return made;
}

TEST(CostReport, tells_median_upper_tail_and_spread_of_repeats) {
  CostReport report;
  report.add({record("map", 100.0), record("shade", 100.0)}, 300.0,
             false);  // compiles: not counted
  for (const double ms : {9.0, 1.0, 5.0, 3.0, 7.0, 2.0, 8.0, 4.0, 6.0})
    report.add({record("map", ms), record("shade", 1.0)}, ms + 2.0, true);
  const Cost cost = report.summary();
  EXPECT_EQ(cost.frames, 9u);
  EXPECT_DOUBLE_EQ(cost.median_ms, 6.0);
  EXPECT_DOUBLE_EQ(cost.p95_ms, 9.6);  // 0.95 of the way from the first to the ninth of 2 to 10
  EXPECT_DOUBLE_EQ(cost.spread, 0.5 * (8.0 - 4.0) / 6.0);
  EXPECT_DOUBLE_EQ(cost.wall_median_ms, 7.0);
  ASSERT_EQ(cost.passes.size(), 2u);
  EXPECT_DOUBLE_EQ(cost.passes[0].median_ms, 5.0);
  EXPECT_DOUBLE_EQ(cost.passes[1].median_ms, 1.0);
}

}  // namespace
}  // namespace penumbra
