#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/engine/engine.h"
#include "experiments/engine/progress_file.h"
#include "server/cli/progress.h"

namespace penumbra::server::cli {

/// What every experiment takes.
struct ExperimentOptions {
  std::filesystem::path out;
  std::filesystem::path data;
  std::string device;
  double run_ms = experiments::TimingBudget{}.run_ms;

  void add_common_to(CLI::App& command);
  experiments::EngineOptions engine() const;
};

/// Shows progress on the terminal and in the experiment's folder.
std::function<void(const experiments::Progress&)> shown(Progress& bar,
                                                        experiments::ProgressFile& file);

/// A list that was given must name something: "," is a slip, not the default.
std::vector<std::string> list_of(const std::string& flag, const std::string& text);

}  // namespace penumbra::server::cli
