#include "experiments/engine/progress_file.h"

#include <fstream>

#include "scenes/json_text.h"

namespace penumbra::experiments {

void ProgressFile::show(const Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (progress.done < progress.total && now - last_ < std::chrono::milliseconds(300)) return;
  last_ = now;
  const auto file = folder_ / "progress.json", next = folder_ / "progress.json.new";
  std::ofstream out(next, std::ios::binary);
  out << scenes::json_text(
      {{"done", progress.done},
       {"total", progress.total},
       {"measured", progress.measured},
       {"left_s", progress.left_s ? nlohmann::json(*progress.left_s) : nlohmann::json(nullptr)},
       {"what", progress.what}});
  out.close();
  // It is a courtesy: an experiment does not fail for it.
  std::error_code ignored;
  if (out) std::filesystem::rename(next, file, ignored);
}

}  // namespace penumbra::experiments
