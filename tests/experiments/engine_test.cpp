// The engine of experiments: what is measured once is never measured again.
#include "experiments/engine/engine.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <utility>

#include "experiments/engine/versions.h"
#include "renderer/error.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::Gt;

Run small_run(const std::string& technique, std::uint32_t size = 32) {
  Run run;
  run.scene = "sweep:1x100x1";
  run.technique = technique;
  run.width = run.height = size;
  run.light_samples = 16;
  return run;
}

EngineOptions options_in(const std::filesystem::path& folder) {
  EngineOptions options;
  options.folder = folder;
  options.timing.run_ms = 20.0;
  return options;
}

std::size_t lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t lines = 0;
  for (std::string line; std::getline(in, line);) ++lines;
  return lines;
}

TEST(Results, drop_a_last_line_that_a_kill_cut_off_and_keep_the_others) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "results.jsonl";
  {
    Results results(file);
    results.add("a", {{"value", 1}});
    results.add("b", {{"value", 2}});
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5);
  Results again(file);
  ASSERT_NE(again.find("a"), nullptr);
  EXPECT_EQ(again.find("a")->at("value"), 1);
  EXPECT_EQ(again.find("b"), nullptr);
  again.add("b", {{"value", 3}});
  EXPECT_EQ(lines_of(file), 2u);
}

/// Empty where another process may write the file now, otherwise the code of its error.
std::string refusal(const std::filesystem::path& file) {
  try {
    const Results results(file);
    return {};
  } catch (const Error& error) {
    return error.code;
  }
}

/// A process that has the results, and a child of it that only waits.
struct Writer {
  explicit Writer(const std::filesystem::path& file) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    process = ::fork();
    if (process == 0) {
      const Results results(file);
      const pid_t waiting = ::fork();
      if (waiting != 0 && ::write(ends[1], &waiting, sizeof(waiting)) != sizeof(waiting)) _exit(1);
      while (true) ::pause();
    }
    EXPECT_EQ(::read(ends[0], &child, sizeof(child)), static_cast<ssize_t>(sizeof(child)));
    ::close(ends[0]);
    ::close(ends[1]);
  }
  ~Writer() {
    kill();
    ::kill(child, SIGKILL);
  }
  void kill() {
    if (process <= 0) return;
    ::kill(process, SIGKILL);
    ::waitpid(std::exchange(process, -1), nullptr, 0);
  }

  pid_t process = -1;
  pid_t child = -1;
};

TEST(Results, of_one_folder_belong_to_one_writer_at_a_time) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "results.jsonl";
  Writer writer(file);
  EXPECT_EQ(refusal(file), "busy");
  writer.kill();
  EXPECT_EQ(refusal(file), "") << "a child that outlives a killed experiment holds its results";
}

TEST(Engine, measures_a_run_once_also_over_restarts) {
  const TemporaryFolder folder;
  json first;
  {
    Engine engine(options_in(folder.path()));
    first = engine.measure(small_run("shadow-map"));
    EXPECT_EQ(engine.measured(), 1u);
    engine.measure(small_run("shadow-map"));
    EXPECT_EQ(engine.measured(), 1u);
    // Another value is another run.
    auto other = small_run("shadow-map");
    other.parameters["map_size"] = std::int64_t{64};
    engine.measure(other);
    EXPECT_EQ(engine.measured(), 2u);
  }
  Engine engine(options_in(folder.path()));
  EXPECT_EQ(engine.measure(small_run("shadow-map")), first);
  EXPECT_EQ(engine.measured(), 0u);
  EXPECT_EQ(lines_of(folder.path() / "results.jsonl"), 2u);
}

TEST(Engine, keys_name_the_version_so_that_only_what_changed_is_measured_anew) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "results.jsonl";
  {
    Engine engine(options_in(folder.path()));
    run_all(engine, {small_run("shadow-map"), small_run("vsm")}, {});
  }
  // As a program would have written it before a file of techniques/vsm changed.
  std::string text;
  {
    std::ifstream in(file);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::string version = technique_version("vsm");
  ASSERT_NE(version, technique_version("shadow-map"));
  const auto at = text.find(version);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, version.size(), "0123456789ab-0123456789ab");
  std::ofstream(file) << text;
  Engine engine(options_in(folder.path()));
  run_all(engine, {small_run("shadow-map"), small_run("vsm")}, {});
  EXPECT_EQ(engine.measured(), 1u);
}

TEST(Engine, draws_none_first_in_every_view_and_scenes_one_after_the_other) {
  const TemporaryFolder folder;
  Engine engine(options_in(folder.path()));
  auto other = small_run("none");
  other.scene = "sweep:5x100x1";
  std::vector<Progress> told;
  const auto rows = run_all(engine,
                            {small_run("shadow-map", 48), small_run("shadow-map"), other,
                             small_run("none", 48), small_run("none")},
                            [&](const Progress& progress) { told.push_back(progress); });
  std::vector<std::string> order;
  for (const json& row : rows)
    order.push_back(row.at("scene").get<std::string>() + " " + row.at("width").dump() + " " +
                    row.at("technique").get<std::string>());
  EXPECT_THAT(order, ElementsAre("sweep:1x100x1 32 none", "sweep:1x100x1 32 shadow-map",
                                 "sweep:1x100x1 48 none", "sweep:1x100x1 48 shadow-map",
                                 "sweep:5x100x1 32 none"));
  EXPECT_DOUBLE_EQ(rows[0].at("over_none").get<double>(), 1.0);
  EXPECT_DOUBLE_EQ(rows[1].at("over_none").get<double>(),
                   rows[1].at("frame_ms").get<double>() / rows[1].at("none_ms").get<double>());
  ASSERT_EQ(told.size(), 6u);
  EXPECT_FALSE(told.front().left_s);
  EXPECT_EQ(told.back().done, 5u);
  ASSERT_TRUE(told[1].left_s);
  EXPECT_THAT(*told[1].left_s, Gt(0.0));
}

TEST(Engine, times_a_view_before_it_judges_and_finds_the_same_errors) {
  std::vector runs{small_run("none"), small_run("shadow-map"), small_run("pcf"),
                   small_run("shadow-map", 48)};
  runs.push_back(small_run("esm"));
  // No sampler filters logarithms.
  runs.back().parameters = {{"filtering", std::string("logarithmic")}, {"mips", true}};
  for (auto& run : runs) run.truth = Truth::area;
  std::vector<json> measured[2];
  for (const bool beside : {false, true}) {
    const TemporaryFolder folder;
    auto options = options_in(folder.path());
    options.judged_beside = beside;
    Engine engine(options);
    measured[beside] = run_all(engine, runs, nullptr);
    EXPECT_EQ(engine.measured(), runs.size());
  }
  ASSERT_EQ(measured[true].size(), runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const json &at_once = measured[false][i], &beside = measured[true][i];
    ASSERT_EQ(beside.at("name"), at_once.at("name"));
    EXPECT_EQ(beside.at("error"), at_once.at("error"));
    if (at_once.at("status") == "failed") continue;
    for (const char* error : {"rms_y", "flip", "visibility_rms", "false_shadow", "missing_shadow"})
      EXPECT_EQ(beside.at(error), at_once.at(error)) << error;
    EXPECT_GE(beside.at("frames").get<int>(), 3) << "of the picture alone, not of what was timed";
    EXPECT_GT(beside.at("none_ms").get<double>(), 0.0);
    // What judges need is no part of a frame's time.
    for (const json& row : {beside, at_once})
      for (const json& pass : row.at("passes")) EXPECT_NE(pass.at("name"), "resolve visibility");
  }
}

TEST(Engine, keeps_what_a_technique_refuses_as_a_result) {
  const TemporaryFolder folder;
  Engine engine(options_in(folder.path()));
  auto run = small_run("esm");
  // No sampler filters logarithms.
  run.parameters = {{"filtering", std::string("logarithmic")}, {"mips", true}};
  const json row = engine.measure(run);
  EXPECT_EQ(row.at("status"), "failed");
  EXPECT_EQ(row.at("error").at("code"), "unsupported");
  EXPECT_EQ(row.at("error").at("field"), "mips");
  EXPECT_THROW(engine.measure(small_run("no-such-technique")), Error);
}

TEST(Engine, finds_acne_without_bias_and_detachment_with_too_much) {
  const TemporaryFolder folder;
  Engine engine(options_in(folder.path()));
  const auto measured = [&](double bias) {
    auto run = small_run("shadow-map", 96);
    run.scene = "sweep:5x100x1";
    run.truth = Truth::hard;
    run.parameters = {
        {"bias_strategy", std::string("constant")}, {"slope_scale", 0.0}, {"bias", bias}};
    return engine.measure(run);
  };
  // Half of the lit texels shade themselves without bias.
  EXPECT_GT(measured(0.0).at("false_shadow").get<double>(), 0.2);
  // Past the depth of the whole scene nothing is shadowed: as much is missing as without shadows.
  auto unshadowed = small_run("none", 96);
  unshadowed.scene = "sweep:5x100x1";
  unshadowed.truth = Truth::hard;
  const json much = measured(100.0), none = engine.measure(unshadowed);
  EXPECT_EQ(much.at("false_shadow"), 0.0);
  EXPECT_GT(none.at("missing_shadow").get<double>(), 0.02);
  EXPECT_NEAR(much.at("missing_shadow").get<double>(), none.at("missing_shadow").get<double>(),
              1e-3);
}

TEST(Engine, reads_techniques_with_parameters) {
  const NamedTechnique technique = read_technique("pcf-hardware-bilinear:kernel=3");
  EXPECT_EQ(technique.id, "pcf-hardware-bilinear");
  EXPECT_EQ(technique.parameters.at("kernel"), ParameterValue(std::int64_t{3}));
  EXPECT_THROW(read_technique("shadow-map:map_size=many"), Error);
  EXPECT_THROW(read_technique("shadow-map:map_size"), Error);
  EXPECT_THROW(read_technique("shadow-map:no_such=1"), Error);
}

}  // namespace
}  // namespace penumbra::experiments
