#pragma once

#include <filesystem>

#include "experiments/engine/engine.h"

namespace penumbra::experiments {

/// Tells other processes how far an experiment is: progress.json in its folder, replaced as a whole
/// at most a few times a second and at the end. {"done","total","measured","left_s","what"}.
class ProgressFile {
 public:
  explicit ProgressFile(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void show(const Progress& progress);

 private:
  std::filesystem::path folder_;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace penumbra::experiments
