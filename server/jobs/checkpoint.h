#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace penumbra::server {

/// Where the parts of pictures that take long are kept, so that one whose worker ends goes on where
/// it was.
struct CheckpointFolder {
  std::filesystem::path path;  ///< empty: nothing is kept
  double every_s = 15.0;       ///< least time between two writes of one picture
};

/// The state of one picture in a file of its own. A disk that is full or fails costs the
/// checkpoint, never the picture.
class Checkpoint {
 public:
  Checkpoint(CheckpointFolder folder, const std::string& id);

  /// What was kept, verified, or nothing.
  std::string load() const;
  /// Keeps `state()` where the last write is long enough ago.
  void offer(const std::function<std::string()>& state);
  /// The picture is done.
  void remove() const;

 private:
  CheckpointFolder folder_;
  std::filesystem::path file_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Within a data folder.
inline std::filesystem::path checkpoint_folder(const std::filesystem::path& data) {
  return data / "checkpoints";
}

/// Removes what was not taken up again within a week.
void sweep_checkpoints(const std::filesystem::path& folder);

}  // namespace penumbra::server
