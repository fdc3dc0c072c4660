#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <string>

#include "server/files/durable_file.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra {

struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

class ProgramTest : public testing::Test {
 protected:
  /// Runs `penumbra ARGUMENTS` in a folder of its own; references stay in one cache for all.
  Outcome run(const std::string& arguments, const std::string& environment = "") {
    const std::string err = (folder.path() / "stderr").string();
    const std::string command = "cd '" + folder.path().string() + "' || exit; " + environment +
                                " XDG_CACHE_HOME='" + PENUMBRA_BINARY_DIR + "/test-cache' '" +
                                PENUMBRA_PROGRAM + "' " + arguments + " 2>'" + err + "'";
    Outcome outcome;
    FILE* pipe = ::popen(command.c_str(), "r");
    char piece[4096];
    for (std::size_t n = 0; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;)
      outcome.out.append(piece, n);
    const int status = ::pclose(pipe);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.err = server::read_whole(err).value_or("");
    return outcome;
  }

  std::string path(const std::string& name) const { return (folder.path() / name).string(); }

  TemporaryFolder folder;
};

}  // namespace penumbra
