// Recommendations: the model against laws whose best choice is known, and the whole on a scene.
#include "experiments/recommend/recommend.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "experiments/recommend/evaluate.h"
#include "experiments/recommend/model.h"
#include "experiments/report/ranks.h"
#include "renderer/error.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::experiments::recommend {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double no_shadows_ms = 2.0;
constexpr double no_shadows_error = 20.0;

/// A scene where candidate a:<i> takes i times the frame without shadows and leaves its error over
/// i, all times `slow` and `hard`.
MeasuredScene scene_of(const std::string& name, int candidates, double slow, double hard) {
  MeasuredScene scene;
  scene.scene = name;
  scene.none = {no_shadows_error, no_shadows_ms, 0.0};
  for (int i = 2; i <= candidates; ++i)
    scene.candidates["a:" + std::to_string(i)] = {hard * no_shadows_error / i,
                                                  slow * no_shadows_ms * i, 1000.0 * i};
  return scene;
}

Choice choose_on(const Measured& others, const MeasuredScene& scene, const Budget& budget) {
  std::vector<std::string> names;
  for (const auto& [name, known] : scene.candidates) names.push_back(name);
  return choose(others, names, scene.none, budget, [&](const std::string& name) {
    return std::optional<Known>(scene.candidates.at(name));
  });
}

TEST(RecommendModel, finds_the_least_error_of_a_law_within_time_and_memory) {
  Measured others{{scene_of("x", 30, 1.0, 1.0), scene_of("y", 30, 1.0, 1.0)}};
  const MeasuredScene scene = scene_of("z", 30, 1.0, 1.0);
  const Choice in_time = choose_on(others, scene, {10.5 * no_shadows_ms, {}});
  EXPECT_EQ(in_time.candidate, "a:10");
  EXPECT_TRUE(in_time.fits);
  EXPECT_EQ(choose_on(others, scene, {10.5 * no_shadows_ms, 7500.0}).candidate, "a:7");
  const Choice out = choose_on(others, scene, {0.5 * no_shadows_ms, {}});
  EXPECT_EQ(out.candidate, "a:2");  // the fastest there is
  EXPECT_FALSE(out.fits);
}

TEST(RecommendModel, learns_from_probes_that_a_scene_is_slower_than_those_known) {
  Measured others{{scene_of("x", 40, 1.0, 1.0), scene_of("y", 40, 1.1, 0.9)}};
  const MeasuredScene scene = scene_of("z", 40, 4.0, 1.0);
  // Four times slower than expected: a5 is the last that fits 20 times `none`.
  const Choice choice = choose_on(others, scene, {20.5 * no_shadows_ms, {}});
  EXPECT_EQ(choice.candidate, "a:5");
  EXPECT_LE(choice.probed.size(), most_probes);
}

TEST(RecommendModel, takes_the_faster_of_two_that_tie) {
  const Probes probes{{"a", {1.00, 8.0, 0.0}}, {"b", {1.01, 2.0, 0.0}}, {"c", {1.5, 1.0, 0.0}}};
  EXPECT_EQ(best_of(probes, {10.0, {}}, 0.02), "b");
  EXPECT_EQ(best_of(probes, {1.5, {}}, 0.02), "c");
  EXPECT_EQ(best_of({}, {1.5, {}}, 0.02), "");
}

TEST(RecommendEvaluation, has_no_regret_where_scenes_are_alike) {
  Measured measured{
      {scene_of("x", 12, 1.0, 1.0), scene_of("y", 12, 1.0, 1.0), scene_of("z", 12, 1.0, 1.0)}};
  const Evaluation result = evaluate(measured);
  // 1.5 times `none` holds nothing: four budgets for each scene.
  EXPECT_EQ(result.cases.size(), 12u);
  EXPECT_EQ(result.time_regret.mean, 0.0);
  EXPECT_EQ(result.error_regret.mean, 0.0);
  EXPECT_EQ(result.fitting, 1.0);
}

TEST(RecommendEvaluation, leaves_the_judged_scene_out) {
  // On z everything takes twice as long as on the others: four times `none` for a:2.
  Measured measured{
      {scene_of("x", 10, 1.0, 1.0), scene_of("y", 10, 1.0, 1.0), scene_of("z", 10, 2.0, 1.0)}};
  std::vector<std::string> chosen;
  for (const Case& each : evaluate(measured).cases)
    if (each.scene == "z") {
      chosen.push_back(each.candidate);
      // Without a probe a:5 seems to fit five times `none`, and a:10 ten times.
      EXPECT_EQ(each.unprobed, each.budget == 5.0 ? "a:5" : "a:10");
    }
  EXPECT_THAT(chosen, ElementsAre("a:2", "a:5"));
}

TEST(RecommendEvaluation, needs_scenes_and_weighs_each_alike) {
  Measured two{{scene_of("x", 4, 1.0, 1.0), scene_of("y", 4, 1.0, 1.0)}};
  EXPECT_THROW(evaluate(two), Error);
  const Estimate mean = mean_over_scenes({{"x", 1.0}, {"x", 3.0}, {"y", 4.0}, {"z", 6.0}});
  EXPECT_DOUBLE_EQ(mean.mean, 4.0);
  EXPECT_GE(mean.low, 2.0);
  EXPECT_LE(mean.high, 6.0);
  EXPECT_LT(mean.low, mean.high);
}

const std::string head =
    "scene,technique,size,status,parameters,frame_ms_median,frame_ms_over_none,"
    "memory_over_none_bytes,rms_y\n";

TEST(RecommendResults, read_what_sweep_and_tradeoff_write_as_one_candidate) {
  Measured measured;
  add_results(measured,
              head +
                  "s,none,64,done,{},4,1,0,20\n"
                  "s,pcf:kernel=7,64,done,\"{\"\"kernel\"\":7}\",8.2,2,1024,5\n"
                  "t,pcf,64,done,\"{\"\"kernel\"\":7}\",8,2,1024,5\n"
                  "s,esm,64,failed,{},,,,\n",
              "rms_y");
  ASSERT_EQ(measured.scenes.size(), 1u);  // t has no row of `none`
  ASSERT_THAT(measured.candidates(), ElementsAre("pcf:kernel=7"));
  const Known& known = measured.scenes[0].candidates.at("pcf:kernel=7");
  EXPECT_EQ(known.ms, 8.0);  // twice `none`, whatever the clock said
  EXPECT_EQ(known.error, 5.0);
}

TEST(RecommendResults, name_what_is_wrong_with_a_file) {
  const auto message_of = [](const std::string& csv) {
    Measured measured;
    try {
      add_results(measured, csv, "rms_y");
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "unreadable");
      EXPECT_EQ(error.field, "from");
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(message_of("scene,technique\ns,pcf\n"), HasSubstr("no status"));
  EXPECT_THAT(message_of(head + "s,pcf,64,done,{},1,fast,0,5\n"), HasSubstr("frame_ms_over_none"));
  EXPECT_THAT(message_of(head + "s,pcf,64,done,7,1,2,0,5\n"), HasSubstr("parameters"));
  EXPECT_THAT(message_of(""), HasSubstr("empty"));
}

TEST(RecommendResults, come_with_the_program_and_name_techniques_that_there_are) {
  const Measured measured = measured_before(false, "rms_y");
  EXPECT_GE(measured.scenes.size(), 13u);
  for (const std::string& name : measured.candidates()) EXPECT_NO_THROW(read_technique(name));
}

TEST(RecommendRanks, are_those_of_table_4_9_without_a_study) {
  const Ranks ranks = perceived_ranks(published_ranks);
  EXPECT_EQ(ranks.mean.size(), 9u);
  EXPECT_EQ(ranks.mean.at("pcf-bilinear-3x3"), 4.4);
  EXPECT_EQ(ranks.mean.at("pcss-nearest"), 4.85);
  EXPECT_FALSE(ranks.of_scene);
  EXPECT_THROW(perceived_ranks("/none/such.json"), Error);
}

TEST(RecommendRanks, are_the_scenes_own_where_people_saw_it) {
  const Ranks car = perceived_ranks(published_ranks, "car");
  EXPECT_TRUE(car.of_scene);
  EXPECT_EQ(car.mean.at("soft-shadow-volumes-2007"), 4.09);  // table 4.3
  EXPECT_FALSE(perceived_ranks(published_ranks, "teapot").of_scene);

  const TemporaryFolder folder;
  const std::string file = folder.path() / "results.json";
  const auto rows = [](double rank) {
    return json::array({{{"technique", "pcss"}, {"weighted_mean_rank", rank}},
                        {{"technique", "none-such"}, {"weighted_mean_rank", 2.0}}});
  };
  const json all{{"overall", {{"techniques", rows(1.5)}}},
                 {"scenes", json::array({{{"scene", "teapot"}, {"techniques", rows(1.25)}}})}};
  std::ofstream(file) << json{{"included_sets", {{"all", all}}}};
  EXPECT_EQ(perceived_ranks(file, "teapot").mean.at("pcss"), 1.25);
  EXPECT_EQ(perceived_ranks(file, "car").mean.at("pcss"), 1.5);
  EXPECT_THAT(perceived_ranks(file).unknown, ElementsAre("none-such"));
}

TEST(RecommendView, turns_cameras_and_lights_about_the_vertical) {
  Scene scene;
  scene.meshes.push_back({});
  scene.meshes[0].positions = {{-1, 0, -1}, {3, 2, 1}};
  scene.instances.push_back({});
  scene.cameras.push_back({});
  scene.cameras[0].position = {0, 1, 5};
  scene.cameras[0].target = {0, 1, 0};
  scene.lights.push_back({});
  scene.lights[0].position = {1, 4, 2};  // two metres along z from the middle (1, 1, 0)
  scene.lights[0].direction = {0, 0, -1};
  const Scene seen = seen_from(scene, {.camera = {}, .camera_turn = 90.0, .light_turn = 90.0});
  EXPECT_NEAR(glm::length(seen.cameras[0].position - glm::dvec3(5, 1, 0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(seen.lights[0].position - glm::dvec3(3, 4, 0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(seen.lights[0].direction - glm::dvec3(-1, 0, 0)), 0.0, 1e-12);
  EXPECT_EQ(View{}.text(), "");
}

class RecommendOnAScene : public testing::Test {
 protected:
  RecommendOnAScene() {
    options.engine.folder = folder.path();
    options.engine.timing.run_ms = 5.0;
    options.scene = "disco-box";
    options.size = 40;
    options.light_samples = 16;
    options.budget_ms = 1000.0;
  }

  const TemporaryFolder folder;
  Options options;
};

TEST_F(RecommendOnAScene, measures_what_it_recommends_and_goes_on_where_it_was) {
  const json first = recommend(options);
  const json& pick = first.at("recommendation");
  EXPECT_TRUE(pick.at("fits"));
  // Nothing that was tried has less error, but for ties.
  for (const json& row : first.at("tried"))
    EXPECT_LE(pick.at("error").get<double>(), 1.021 * row.at("error").get<double>());
  EXPECT_FALSE(first.at("savings").empty());
  const json again = recommend(options);
  EXPECT_EQ(again.at("measured"), 0);
  EXPECT_EQ(again.at("recommendation"), pick);
}

TEST_F(RecommendOnAScene, says_what_the_scene_refuses_and_why) {
  // Cascades are for directional lights; the lamps of this scene are spots.
  const auto file = folder.path() / "measured.csv";
  std::ofstream(file)
      << head << "s,none,64,done,{},4,1,0,20\n"
      << "s,pcf:layout=cascaded,64,done,\"{\"\"layout\"\":\"\"cascaded\"\"}\",8,2,1024,5\n";
  options.from = {file.string()};
  const json found = recommend(options);
  ASSERT_EQ(found.at("refused").size(), 1u);
  EXPECT_EQ(found.at("refused")[0].at("name"), "pcf:layout=cascaded");
  EXPECT_THAT(found.at("refused")[0].at("reason").get<std::string>(), HasSubstr("directional"));
}

TEST_F(RecommendOnAScene, keeps_to_a_budget_of_memory) {
  options.memory_bytes = 100'000.0;  // less than any map takes
  const json found = recommend(options).at("recommendation");
  EXPECT_LE(found.at("memory_bytes"), 100'000.0);
  EXPECT_TRUE(found.at("fits"));
}

TEST_F(RecommendOnAScene, says_that_nothing_keeps_to_a_budget) {
  options.memory_bytes = 0.0;
  const json found = recommend(options).at("recommendation");
  EXPECT_FALSE(found.at("fits"));
}

TEST_F(RecommendOnAScene, tries_in_the_order_in_which_people_ranked) {
  options.objective = "perceived";
  options.scene = "sweep:1x100x1";
  const json found = recommend(options);
  const Ranks ranks = perceived_ranks(published_ranks);
  double least = 10.0;
  for (const auto& [name, rank] : ranks.mean) least = std::min(least, rank);
  EXPECT_EQ(found.at("recommendation").at("error"), least);
}

TEST_F(RecommendOnAScene, judges_the_worst_of_several_views) {
  options.objective = "worst";
  options.scene = "sweep:1x100x1";
  options.budget_ms = 0.001;  // nothing fits: as few candidates as can be
  const json found = recommend(options);
  EXPECT_FALSE(found.at("recommendation").at("fits"));
  std::ifstream page(folder.path() / "report.html");
  const std::string html(std::istreambuf_iterator<char>(page), {});
  EXPECT_THAT(html, HasSubstr("keeps the budget"));
}

TEST_F(RecommendOnAScene, names_the_field_that_is_wrong) {
  const auto field_of = [&](auto change) {
    Options changed = options;
    change(changed);
    try {
      recommend(changed);
    } catch (const Error& error) {
      return error.field;
    }
    return std::string("nothing");
  };
  EXPECT_EQ(field_of([](Options& o) { o.budget_ms = 0.0; }), "budget_ms");
  EXPECT_EQ(field_of([](Options& o) { o.budget_ms = std::nan(""); }), "budget_ms");
  EXPECT_EQ(field_of([](Options& o) { o.memory_bytes = -1.0; }), "memory_bytes");
  EXPECT_EQ(field_of([](Options& o) { o.objective = "beauty"; }), "objective");
  EXPECT_EQ(field_of([](Options& o) { o.study = "results.json"; }), "study");  // not for rms
  EXPECT_EQ(field_of([](Options& o) { o.size = 0; }), "size");
  EXPECT_EQ(field_of([](Options& o) { o.from = {"/none/such.csv"}; }), "from");
  EXPECT_EQ(field_of([](Options& o) { o.scene = "nowhere"; }), "scene");
}

}  // namespace
}  // namespace penumbra::experiments::recommend
