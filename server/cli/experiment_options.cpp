#include "server/cli/experiment_options.h"

#include <cmath>
#include <memory>

#include "renderer/error.h"
#include "server/jobs/device_lock.h"

namespace penumbra::server::cli {
namespace {

/// How long a run waits for others that draw on the device, seconds: there are thousands of runs.
constexpr double patience_s = 2.0;

}  // namespace

void ExperimentOptions::add_common_to(CLI::App& command) {
  command.add_option("--out", out, "Folder of results, figures and report; made if not there")
      ->required();
  command.add_option("--data", data, "Folder of imported scenes");
  command.add_option("--device", device, "Vulkan device: part of its name, or its index");
  command.add_option("--run-ms", run_ms, "Frames are timed for about so long a run, milliseconds")
      ->check(CLI::Range(1.0, 60000.0))
      ->capture_default_str();
}

experiments::EngineOptions ExperimentOptions::engine() const {
  experiments::EngineOptions engine;
  engine.folder = out;
  engine.data = data;
  engine.device = device;
  engine.timing.run_ms = run_ms;
  engine.alone = [] { return std::make_shared<DeviceLock>(DeviceLock::Mode::measure, patience_s); };
  return engine;
}

std::function<void(const experiments::Progress&)> shown(Progress& bar,
                                                        experiments::ProgressFile& file) {
  return [&bar, &file](const experiments::Progress& now) {
    file.show(now);
    if (now.total == 0) return;
    std::string text = std::to_string(now.done) + " of " + std::to_string(now.total);
    if (now.left_s) text += ", " + std::to_string(std::lround(*now.left_s)) + " s left";
    bar.show(static_cast<double>(now.done) / static_cast<double>(now.total), text + " " + now.what);
  };
}

std::vector<std::string> list_of(const std::string& flag, const std::string& text) {
  auto parts = experiments::parts_of(text);
  if (!text.empty() && parts.empty()) throw bad_value(flag, "--" + flag + " names nothing");
  return parts;
}

}  // namespace penumbra::server::cli
