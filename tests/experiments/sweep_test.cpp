// Limits, growth and order of a sweep, against numbers worked out by hand.
#include "experiments/sweep/sweep.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <set>

#include "experiments/sweep/grid.h"
#include "experiments/sweep/limits.h"
#include "experiments/sweep/report.h"
#include "renderer/error.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;

json row_at(int objects, int size, double ms, const std::string& name = "shadow-map",
            int triangles = 100) {
  return {{"scene", sweep_scene({objects, triangles, 3})},
          {"technique", name},
          {"name", name},
          {"width", size},
          {"status", "done"},
          {"error", nullptr},
          {"settled", true},
          {"frame_ms", ms},
          {"over_none", 1.0},
          {"fragments", 2.0 * size * size}};
}

TEST(SweepGrid, has_the_588_combinations_of_2007_and_882_with_10000_triangles) {
  EXPECT_EQ(sweep_runs({.techniques = {"none"}}, true).size(), 588u);
  EXPECT_EQ(sweep_runs({.scenes = {"sweep:*"}, .techniques = {"none"}}, true).size(), 882u);
}

TEST(SweepGrid, takes_patterns_and_names_each_scene_once) {
  EXPECT_EQ(matching_scenes({"sweep:*x1600x3"}).size(), 7u);
  EXPECT_EQ(matching_scenes({"sweep:25x*x1", "sweep:25x100x?", "boxes"}).size(), 6u);
  EXPECT_THROW(matching_scenes({"sweep:3x*"}), Error);
  EXPECT_THROW(sweep_runs({.techniques = {"paint"}}, true), Error);
  EXPECT_THROW(sweep_runs({.sizes = {0}}, true), Error);
}

TEST(SweepLimits, interpolate_between_counts_and_take_the_largest_size_in_real_time) {
  // 10 ms for each object at 100 pixels, 20 at 200.
  std::vector<json> rows;
  for (const int objects : {1, 2, 4, 8})
    for (const int size : {100, 200}) rows.push_back(row_at(objects, size, objects * size / 10.0));
  const auto limits = limits_of(time_grid(rows, "shadow-map", 100, 3));
  ASSERT_TRUE(limits);
  EXPECT_EQ(limits->objects, 4);  // 40 ms at 100, 80 at 200
  EXPECT_EQ(limits->size, 100.0);
  EXPECT_DOUBLE_EQ(limits->at_largest, 2.5);  // 50 ms between 40 at 2 and 80 at 4
  EXPECT_FALSE(limits->beyond);
  EXPECT_FALSE(limits_of(time_grid(rows, "vsm", 100, 3)));
}

TEST(SweepLimits, say_where_nothing_or_everything_is_fast_enough) {
  const auto slow = limits_of(time_grid({row_at(1, 100, 60.0)}, "shadow-map", 100, 3));
  EXPECT_EQ(slow->objects, 0);
  EXPECT_EQ(slow->at_largest, 0.0);
  const auto fast = limits_of(time_grid({row_at(9, 100, 1.0)}, "shadow-map", 100, 3));
  EXPECT_TRUE(fast->beyond);
  EXPECT_EQ(fast->at_largest, 9.0);
}

TEST(SweepLimits, find_the_exponents_of_a_power_law) {
  std::vector<json> rows;
  for (const int objects : {1, 10, 100})
    for (const int size : {100, 300, 900})
      rows.push_back(
          row_at(objects, size, 0.01 * std::pow(size * size, 0.75) * std::sqrt(objects)));
  const auto growth = growth_of(time_grid(rows, "shadow-map", 100, 3));
  ASSERT_TRUE(growth);
  EXPECT_NEAR(growth->over_pixels, 0.75, 1e-9);
  EXPECT_NEAR(growth->over_objects, 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(growth->fragments_per_pixel, 2.0);
  EXPECT_EQ(bottleneck_of(*growth, *growth), "shaders");
  EXPECT_EQ(bottleneck_of({0.75, 0.5, 11.0}, *growth), "fill rate");
  EXPECT_EQ(bottleneck_of({0.1, 0.9, 2.0}, *growth), "geometry");
}

TEST(SweepLimits, count_pairs_in_the_published_order) {
  // 1-2, 1-3 agree; 2-3 does not; 4 ties with 3.
  const Agreement order = agreement({1.0, 3.0, 2.0, 2.0}, {1.0, 2.0, 3.0, 4.0});
  EXPECT_EQ(order.pairs, 5u);
  EXPECT_EQ(order.agreeing, 3u);
}

TEST(Sweep, writes_results_figures_and_one_page_that_needs_nothing_else) {
  const TemporaryFolder folder;
  SweepOptions options;
  options.engine.folder = folder.path();
  options.engine.timing.run_ms = 10.0;
  options.scenes = {"sweep:1x100x3", "sweep:5x100x3"};
  options.techniques = {"shadow-map", "shadow-map:map_size=64"};
  options.sizes = {16, 32};
  options.command = "penumbra sweep <here>";
  const json summary = sweep(options);
  EXPECT_EQ(summary.at("rows"), 12);
  EXPECT_EQ(summary.at("failed"), 0);
  for (const auto& file : summary.at("files"))
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file.get<std::string>())) << file;
  std::ifstream in(folder.path() / "results.csv");
  std::set<std::string> distinct;
  for (std::string line; std::getline(in, line);) distinct.insert(line);
  EXPECT_EQ(distinct.size(), 13u);
  std::ifstream page(folder.path() / "report.html");
  const std::string html(std::istreambuf_iterator<char>(page), {});
  EXPECT_EQ(html.find("src=\"http"), std::string::npos);
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_NE(html.find("penumbra sweep &lt;here&gt;"), std::string::npos);
  EXPECT_NE(html.find("Table 4.1 today"), std::string::npos);
  EXPECT_EQ(sweep(options).at("measured"), 0);
}

}  // namespace
}  // namespace penumbra::experiments
