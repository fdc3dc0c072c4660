// The search over parameters, against laws whose fronts are known.
#include "experiments/tradeoff/tradeoff.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "experiments/tradeoff/report.h"
#include "experiments/tradeoff/search.h"
#include "renderer/error.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;
using testing::ElementsAre;

Parameter integer(const std::string& name, std::int64_t value, double low, double high) {
  Parameter parameter;
  parameter.name = name;
  parameter.type = ParameterType::integer;
  parameter.default_value = value;
  parameter.minimum = low;
  parameter.maximum = high;
  parameter.scale = ParameterScale::logarithmic;
  return parameter;
}

double value_of(const ParameterValues& given, const Parameter& parameter) {
  const auto found = given.find(parameter.name);
  return static_cast<double>(
      std::get<std::int64_t>(found == given.end() ? parameter.default_value : found->second));
}

TEST(ParameterSearch, follows_the_front_of_a_law_to_both_ends_and_leaves_what_is_useless) {
  const Parameter size = integer("size", 64, 8, 1024);
  const Parameter idle = integer("idle", 1, 1, 256);  // more of it costs and does nothing
  std::size_t idle_runs = 0, runs = 0;
  const auto found = search({size, idle}, 30, [&](const ParameterValues& given) {
    ++runs;
    if (given.contains("idle")) ++idle_runs;
    const double s = value_of(given, size);
    return std::optional<Scores>({s * s + value_of(given, idle), {1.0 / s}});
  });
  EXPECT_EQ(runs, found.size());
  EXPECT_EQ(idle_runs, 1u);
  std::vector<double> sizes;
  for (const std::size_t index : front_of(found, 0))
    sizes.push_back(value_of(found[index].given, size));
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  EXPECT_THAT(sizes, ElementsAre(8, 16, 32, 64, 128, 256, 512, 1024));
}

TEST(ParameterSearch, never_ablates_however_well_it_would_pay) {
  const Parameter size = integer("size", 64, 8, 1024);
  const Parameter without = choice("without", "nothing", {"nothing", "caps"}, "").ablating();
  for (const Found& found : search({size, without}, 30, [&](const ParameterValues& given) {
         const double s = value_of(given, size);
         return std::optional<Scores>({given.contains("without") ? 1.0 : s, {1.0 / s}});
       }))
    EXPECT_FALSE(found.given.contains("without"));
}

TEST(ParameterSearch, keeps_to_its_budget_and_goes_on_past_what_is_refused) {
  const Parameter size = integer("size", 64, 8, 1024);
  const auto found = search({size}, 4, [&](const ParameterValues& given) -> std::optional<Scores> {
    if (value_of(given, size) > 64.0) return std::nullopt;
    return Scores{value_of(given, size), {1.0 / value_of(given, size)}};
  });
  EXPECT_EQ(found.size(), 4u);
  EXPECT_EQ(front_of(found, 0).size(), 3u);  // 64, 32, 16; 128 was refused
}

TEST(ParameterSearch, steps_stay_in_the_range) {
  const Parameter size = integer("size", 64, 8, 100);
  EXPECT_THAT(steps_from(size, std::int64_t{64}), ElementsAre(ParameterValue(std::int64_t{32})));
  Parameter bias;
  bias.type = ParameterType::real;
  bias.maximum = 16.0;
  EXPECT_THAT(steps_from(bias, 0.0), ElementsAre(ParameterValue(1.0)));
  Parameter choice;
  choice.type = ParameterType::choice;
  choice.choices = {"a", "b", "c"};
  EXPECT_THAT(steps_from(choice, std::string("b")),
              ElementsAre(ParameterValue(std::string("a")), ParameterValue(std::string("c"))));
}

TEST(Tradeoff, fronts_hold_what_nothing_beats) {
  std::vector<json> rows;
  for (const auto& [ms, error] :
       std::vector<std::pair<double, double>>{{1, 9}, {2, 5}, {3, 6}, {4, 1}, {5, 1}})
    rows.push_back({{"status", "done"}, {"frame_ms", ms}, {"flip", error}});
  rows.push_back({{"status", "failed"}});
  EXPECT_THAT(front_rows(rows, "flip"), ElementsAre(0, 1, 3));
}

/// A search of one technique in small pictures.
TradeoffOptions small_search(const TemporaryFolder& folder, const std::string& scene,
                             std::size_t runs) {
  TradeoffOptions options;
  options.engine.folder = folder.path();
  options.engine.timing.run_ms = 5.0;
  options.scene = scene;
  options.techniques = {"shadow-map"};
  options.size = 32;
  options.light_samples = 16;
  options.runs_per_technique = runs;
  return options;
}

TEST(Tradeoff, searches_a_scene_and_goes_on_where_it_was) {
  const TemporaryFolder folder;
  const TradeoffOptions options = small_search(folder, "sweep:1x100x1", 6);
  const json first = tradeoff(options);
  EXPECT_EQ(first.at("rows"), 7);
  // The fastest of a front is at most as exact as the others, and none is the fastest of all or
  // worse than one that is.
  for (const Objective& objective : objectives()) {
    const json& front = first.at("fronts").at(objective.key);
    ASSERT_FALSE(front.empty());
    for (std::size_t i = 1; i < front.size(); ++i) {
      EXPECT_LE(front[i - 1].at("frame_ms"), front[i].at("frame_ms"));
      EXPECT_GE(front[i - 1].at(objective.key), front[i].at(objective.key));
    }
  }
  const json again = tradeoff(options);
  EXPECT_EQ(again.at("measured"), 0);
  EXPECT_EQ(again.at("fronts"), first.at("fronts"));
  std::ifstream page(folder.path() / "report.html");
  const std::string html(std::istreambuf_iterator<char>(page), {});
  EXPECT_NE(html.find("src=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos);
}

TEST(Tradeoff, holds_what_people_ranked_against_time) {
  const TemporaryFolder folder;
  TradeoffOptions options = small_search(folder, "boxes", 2);
  options.study = published_ranks;
  const json found = tradeoff(options);
  const Ranks ranks = perceived_ranks(published_ranks, "boxes");
  ASSERT_TRUE(ranks.of_scene);
  // None, the search's two, and what was ranked: the map is among the search's.
  EXPECT_EQ(found.at("rows"), 3 + ranks.mean.size() - 1);
  const json& front = found.at("fronts").at("perceived");
  ASSERT_FALSE(front.empty());
  double best = 10.0;
  for (const auto& [name, rank] : ranks.mean) best = std::min(best, rank);
  EXPECT_EQ(front.back().at("perceived"), best);
  for (const Objective& objective : objectives())
    for (const json& row : found.at("fronts").at(objective.key))
      EXPECT_NE(row.at("technique"), "reference") << "judged by itself";
  for (const json& row : front)
    EXPECT_EQ(row.at("perceived"), ranks.mean.at(row.at("name").get<std::string>()));
  std::ifstream table(folder.path() / "results.csv");
  std::string head;
  std::getline(table, head);
  EXPECT_NE(head.find(",perceived,"), std::string::npos) << head;
}

TEST(Tradeoff, refuses_what_has_no_bias_and_presets) {
  TradeoffOptions options;
  options.scene = "boxes";
  options.bias = true;
  options.techniques = {"shadow-volumes"};
  EXPECT_THROW(tradeoff(options), Error);
  options.techniques = {"shadow-map"};
  options.study = published_ranks;  // people ranked no biases
  EXPECT_THROW(tradeoff(options), Error);
  options.study.clear();
  options.bias = false;
  options.techniques = {"vsm-2007"};
  EXPECT_THROW(tradeoff(options), Error);
}

}  // namespace
}  // namespace penumbra::experiments
