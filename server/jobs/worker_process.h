#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "server/jobs/child_process.h"
#include "server/jobs/message.h"

namespace penumbra::server {

/// The worker is gone: crashed, killed, or not speaking the protocol. Its request may be tried
/// again.
class WorkerLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Somebody cancelled: the worker was killed.
class WorkCancelled : public std::runtime_error {
 public:
  WorkCancelled() : std::runtime_error("cancelled") {}
};

struct WorkerCommand {
  std::vector<std::string> arguments;  ///< program first
  std::filesystem::path driver_cache;  ///< compiled shaders of the driver; may be empty
  double start_s = 60.0;               ///< time to open a device and say hello
};

/// One child process, killed with this object. Its thread is the one that made it: the kernel ends
/// a worker together with the thread that started it.
class WorkerProcess {
 public:
  /// Starts it and waits for its hello; `cancelled` is asked often. Throws WorkerLost,
  /// WorkCancelled, or the Error that the worker told.
  WorkerProcess(const WorkerCommand& command, const std::function<bool()>& cancelled);

  const nlohmann::json& device() const { return device_; }
  const DeviceLimits& limits() const { return limits_; }

  /// Sends a task and waits for its answer: the body under `done`, and the files. `progress` gets
  /// 0..1; `cancelled` is asked often. Throws the worker's Error, Error `deadline` (the process is
  /// killed), WorkCancelled (killed) or WorkerLost.
  Message run(const Message& task, double deadline_s, const std::function<void(double)>& progress,
              const std::function<bool()>& cancelled);

  /// False once it was killed or said that it ends; make a new one then.
  bool alive() const { return child_->running(); }

  /// How it ended where it did so without a task; it is not alive then.
  std::optional<std::string> died_idle();

 private:
  [[noreturn]] void lost(const std::string& during);
  /// What became of an exchange: returns where the message passed, otherwise ends the worker and
  /// throws.
  void require_message(Exchange outcome);
  Message read(std::chrono::steady_clock::time_point deadline,
               const std::function<bool()>& cancelled);
  [[noreturn]] void raise(const nlohmann::json& body);

  std::unique_ptr<ChildProcess> child_;
  MessageReader reader_;
  nlohmann::json device_;
  DeviceLimits limits_;
};

}  // namespace penumbra::server
