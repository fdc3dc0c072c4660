// Experiments of the built program: what a kill leaves is gone on with.
#include <gmock/gmock.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/jobs/temporary_folder.h"

extern char** environ;

namespace {

struct Experiment {
  const char* name;
  std::vector<std::string> arguments;
};

pid_t start(const Experiment& experiment, const std::filesystem::path& out) {
  std::vector<std::string> texts{PENUMBRA_PROGRAM};
  texts.insert(texts.end(), experiment.arguments.begin(), experiment.arguments.end());
  texts.push_back("--out=" + out.string());
  std::vector<char*> arguments;
  for (std::string& text : texts) arguments.push_back(text.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  EXPECT_EQ(::posix_spawn(&process, texts[0].c_str(), nullptr, nullptr, arguments.data(), environ),
            0);
  return process;
}

std::vector<std::string> lines_of(const std::string& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line) && !in.eof();) lines.push_back(line);
  return lines;
}

class KilledExperiment : public testing::TestWithParam<Experiment> {};

TEST_P(KilledExperiment, goes_on_and_repeats_no_run) {
  const TemporaryFolder folder;
  const std::string results = (folder.path() / "results.jsonl").string();
  const pid_t first = start(GetParam(), folder.path());
  while (lines_of(results).size() < 4) {
    ASSERT_EQ(::waitpid(first, nullptr, WNOHANG), 0) << "it ended by itself";
    ::usleep(2000);
  }
  ::kill(first, SIGKILL);
  ::waitpid(first, nullptr, 0);
  const auto before = lines_of(results);
  ASSERT_FALSE(std::filesystem::exists(folder.path() / "report.html")) << "it was over already";

  int status = 0;
  ::waitpid(start(GetParam(), folder.path()), &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const auto after = lines_of(results);
  ASSERT_GT(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i], before[i]);
  std::set<std::string> keys;
  for (const std::string& line : after) keys.insert(nlohmann::json::parse(line).at("key"));
  EXPECT_EQ(keys.size(), after.size()) << "a run was repeated";
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "report.html"));
}

INSTANTIATE_TEST_SUITE_P(
    All, KilledExperiment,
    testing::Values(
        Experiment{"sweep",
                   {"sweep", "--scenes=sweep:1x100x1,sweep:5x100x1",
                    "--techniques=shadow-map,vsm,pcf-3x3", "--sizes=32,64", "--run-ms=5"}},
        Experiment{"tradeoff",
                   {"tradeoff", "sweep:1x100x1", "--techniques=pcf", "--size=32",
                    "--light-samples=16", "--run-ms=2"}},
        Experiment{"bias", {"tradeoff", "sweep:1x100x1", "--bias", "--size=24", "--run-ms=1"}},
        Experiment{"recommend",
                   {"recommend", "sweep:1x100x1", "--size=32", "--light-samples=16", "--run-ms=2"}},
        Experiment{"claims", {"claims", "--only=C01,C21,C22,C06", "--quick", "--run-ms=1"}},
        Experiment{"stability",
                   {"stability", "--techniques=shadow-map", "--axes=small-picture,ground"}}),
    [](const auto& each) { return std::string(each.param.name); });

}  // namespace
