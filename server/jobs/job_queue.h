#pragma once

#include <deque>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "server/jobs/canonical_request.h"
#include "server/jobs/render_service.h"

namespace penumbra::server {

/// A render on its way. Guarded by the queue's mutex.
struct Job {
  CanonicalRequest request;
  std::set<std::string> wants;  ///< grows while it waits; what joins while it runs is done after
  RenderRecord record;
  unsigned interest = 0;  ///< submitters that have not cancelled
  bool cancelled = false;
  bool alone = false;  ///< a measurement: nothing else may run beside it
};

/// First come, first served; a measurement waits until nothing runs and then runs alone. The queue
/// has no lock of its own: its owner calls under one.
class JobQueue {
 public:
  void push(std::shared_ptr<Job> job) { waiting_.push_back(std::move(job)); }

  /// The next job that may run now, marked as running; null where none may.
  std::shared_ptr<Job> take() {
    if (waiting_.empty() || alone_) return nullptr;
    if (waiting_.front()->alone && running_ > 0) return nullptr;
    std::shared_ptr<Job> job = std::move(waiting_.front());
    waiting_.pop_front();
    ++running_;
    alone_ = job->alone;
    return job;
  }

  void finished(const Job&) {
    --running_;
    alone_ = false;
  }

  bool remove(const Job& job) {
    for (auto it = waiting_.begin(); it != waiting_.end(); ++it) {
      if (it->get() != &job) continue;
      waiting_.erase(it);
      return true;
    }
    return false;
  }

  std::deque<std::shared_ptr<Job>> take_all() { return std::exchange(waiting_, {}); }
  std::size_t waiting() const { return waiting_.size(); }
  unsigned running() const { return running_; }

 private:
  std::deque<std::shared_ptr<Job>> waiting_;
  unsigned running_ = 0;
  bool alone_ = false;
};

}  // namespace penumbra::server
