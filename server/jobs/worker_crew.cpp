#include "server/jobs/worker_crew.h"

#include <algorithm>

#include "renderer/error.h"

namespace penumbra::server {
namespace {

/// One crash is bad luck and one more its retry; from the third on it is a pattern.
constexpr unsigned failures_before_breaker = 3;
constexpr auto first_pause = std::chrono::milliseconds(500);
constexpr auto longest_pause = std::chrono::seconds(60);

}  // namespace

std::chrono::steady_clock::duration WorkerCrew::pause() const {
  if (failures_ < failures_before_breaker) return {};
  const unsigned doublings = std::min(failures_ - failures_before_breaker, 10u);
  return std::min<std::chrono::steady_clock::duration>(first_pause * (1u << doublings),
                                                       longest_pause);
}

std::unique_ptr<WorkerProcess> WorkerCrew::start() {
  {
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, pause(), [this] { return stopping_; })) return nullptr;
  }
  try {
    auto process = std::make_unique<WorkerProcess>(command_, [this] {
      const std::lock_guard lock(mutex_);
      return stopping_;
    });
    const std::lock_guard lock(mutex_);
    ++alive_;
    ++started_;
    device_ = process->device();
    limits_ = process->limits();
    changed_.notify_all();
    return process;
  } catch (const WorkCancelled&) {
    return nullptr;
  } catch (const std::exception& error) {
    failed(error.what());
    return nullptr;
  }
}

void WorkerCrew::succeeded() {
  const std::lock_guard lock(mutex_);
  failures_ = 0;
  last_failure_.clear();
}

void WorkerCrew::failed(const std::string& why) {
  const std::lock_guard lock(mutex_);
  ++failures_;
  ++deaths_;
  last_failure_ = why;
  changed_.notify_all();
}

void WorkerCrew::ended() {
  const std::lock_guard lock(mutex_);
  --alive_;
}

void WorkerCrew::stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
}

bool WorkerCrew::breaker_open() const {
  return failures_ >= failures_before_breaker && alive_ == 0;
}

std::string WorkerCrew::trouble() {
  const std::lock_guard lock(mutex_);
  if (!breaker_open()) return {};
  return "no renderer is running, the last one failed: " + last_failure_;
}

nlohmann::json WorkerCrew::device() {
  const std::lock_guard lock(mutex_);
  return device_;
}

DeviceLimits WorkerCrew::limits(double patience_s) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(patience_s),
                    [this] { return stopping_ || started_ > 0 || breaker_open(); });
  return limits_;
}

nlohmann::json WorkerCrew::statistics() {
  const std::lock_guard lock(mutex_);
  return {{"workers_alive", alive_},
          {"workers_started", started_},
          {"worker_deaths", deaths_},
          {"breaker_open", failures_ >= failures_before_breaker},
          {"device", device_}};
}

}  // namespace penumbra::server
