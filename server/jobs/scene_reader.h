#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <semaphore>
#include <string>
#include <vector>

#include "server/jobs/message.h"

namespace penumbra::server {

struct SceneReaderOptions {
  std::vector<std::string> command;  ///< a worker's; empty: this very program's
  std::uint64_t memory_limit = 0;    ///< bytes that reading may add to an address space
  double deadline_s = 60.0;
};

/// A picture that was uploaded, as it is shown.
struct UploadedPicture {
  std::string png;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Pixels of an uploaded picture at most: a photograph of 16 megapixels.
inline constexpr std::uint64_t most_uploaded_pixels = 1u << 24;

/// Reads an uploaded file for good in a process of its own, so that what a file does to its reader,
/// a fault, endless work, all memory, costs that file. Few run at once. Thread-safe.
class SceneReader {
 public:
  explicit SceneReader(SceneReaderOptions options);

  /// {"title","notes"} of the scene. `stopping` is asked often. Throws the reader's Error;
  /// `unreadable` where the reader died at the file, `deadline` where it took too long, `busy`
  /// where others are read for as long, `draining` where it was stopped.
  nlohmann::json read(const std::filesystem::path& file, const std::function<bool()>& stopping);

  /// A PNG, JPEG or WebP of at most `most_uploaded_pixels`; throws as `read`.
  UploadedPicture read_picture(const std::filesystem::path& file,
                               const std::function<bool()>& stopping);

  nlohmann::json statistics() const;

 private:
  Message read_with(const char* option, const std::filesystem::path& file,
                    const std::function<bool()>& stopping);

  static constexpr int most_at_once = 2;

  SceneReaderOptions options_;
  std::counting_semaphore<most_at_once> places_{most_at_once};
  std::atomic<std::uint64_t> read_ = 0, refused_ = 0, died_ = 0, deadlines_ = 0;
};

/// What the process does: reads the file, writes {"scene"} or {"error"} to standard output as a
/// message (message.h).
int run_scene_reader(const std::filesystem::path& file, std::uint64_t memory_limit);

/// The same for a picture: {"picture": {"width", "height"}} and the PNG, or {"error"}.
int run_picture_reader(const std::filesystem::path& file, std::uint64_t memory_limit);

}  // namespace penumbra::server
