#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "server/jobs/checkpoint.h"

namespace penumbra::server {

struct WorkerOptions {
  std::string device;
  std::filesystem::path data;
  bool validation = false;
  /// Address space that drawing may add once the device is open, bytes; 0: the share of the only
  /// worker. Drivers map far more than they use, hence counted from there.
  std::uint64_t memory_limit = 0;
  /// Only read this scene file and say what it is (scene_reader.h); no device is opened.
  std::filesystem::path read_scene;
  /// The same for a picture, which is written as PNG.
  std::filesystem::path read_picture;
  double checkpoint_s = CheckpointFolder{}.every_s;  ///< as CheckpointFolder::every_s
};

/// The child process that owns a Vulkan device. Protocol (message.h) on standard input and output:
///   worker: {"hello":{"renderer","device","limits"}}  or  {"error":{..},"fatal":true} and the end
///   server: {"task":{"request","id","wants","frames"},"reference":{"id","noise_rms_y"}} and the
///           reference's files
///   worker: {"progress":0.5} ..., then {"done":{"cost","quality","noise_rms_y","notes"}} and
///   files,
///           or {"error":{"code","message","field"},"fatal":false}
/// After a fatal error the worker ends by itself, without asking the driver to tidy up: that may
/// wait for a queue that never finishes.
int run_worker(const WorkerOptions& options);

}  // namespace penumbra::server
