// Experiments of the built program: what a kill leaves is gone on with.
#include <gmock/gmock.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/jobs/temporary_folder.h"

extern char** environ;

namespace {

pid_t start_sweep(const std::string& out) {
  std::vector<std::string> texts{PENUMBRA_PROGRAM,
                                 "sweep",
                                 "--scenes=sweep:1x100x1,sweep:5x100x1",
                                 "--techniques=shadow-map,vsm,pcf-3x3",
                                 "--sizes=32,64",
                                 "--run-ms=5",
                                 "--out=" + out};
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

TEST(SweepCommand, killed_in_the_middle_goes_on_and_repeats_no_run) {
  const TemporaryFolder folder;
  const std::string results = (folder.path() / "results.jsonl").string();
  const pid_t first = start_sweep(folder.path().string());
  while (lines_of(results).size() < 4) {
    ASSERT_EQ(::waitpid(first, nullptr, WNOHANG), 0) << "it ended by itself";
    ::usleep(2000);
  }
  ::kill(first, SIGKILL);
  ::waitpid(first, nullptr, 0);
  const auto before = lines_of(results);
  ASSERT_LT(before.size(), 16u) << "it was over before the kill";

  int status = 0;
  ::waitpid(start_sweep(folder.path().string()), &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const auto after = lines_of(results);
  ASSERT_EQ(after.size(), 16u);  // two scenes, two sizes, three techniques and none
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i], before[i]);
  std::set<std::string> keys;
  for (const std::string& line : after) keys.insert(nlohmann::json::parse(line).at("key"));
  EXPECT_EQ(keys.size(), 16u);
  EXPECT_EQ(lines_of((folder.path() / "results.csv").string()).size(), 17u);
}

}  // namespace
