#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "server/jobs/worker_process.h"

namespace penumbra::server {

/// Starts workers and decides when to try again: after failures in a row it waits, longer each
/// time, so that a driver which crashes at once does not keep the machine busy. Thread-safe.
class WorkerCrew {
 public:
  explicit WorkerCrew(WorkerCommand command) : command_(std::move(command)) {}

  /// A started worker; waits while the breaker is open, so never within a job. Null once stop() was
  /// called or where the worker did not start: trouble() tells why.
  std::unique_ptr<WorkerProcess> start();

  /// A worker finished a task: the driver works.
  void succeeded();

  /// A worker died at its task.
  void failed(const std::string& why);

  void ended();  ///< a started worker is no more
  void stop();

  /// Why no picture can be drawn at the moment, or empty.
  std::string trouble();

  nlohmann::json device();  ///< of the last hello, or null

  /// Of the last hello. Waits for the first one up to `patience_s` seconds or until there is
  /// trouble; nothing is known then.
  DeviceLimits limits(double patience_s);
  nlohmann::json statistics();

 private:
  std::chrono::steady_clock::duration pause() const;
  bool breaker_open() const;  ///< and no worker lives; under the mutex

  WorkerCommand command_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  unsigned alive_ = 0;
  unsigned failures_ = 0;  ///< in a row
  std::uint64_t started_ = 0;
  std::uint64_t deaths_ = 0;
  std::string last_failure_;
  nlohmann::json device_;
  DeviceLimits limits_;
};

}  // namespace penumbra::server
