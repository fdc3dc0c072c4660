#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/jobs/canonical_request.h"
#include "server/jobs/render_service.h"

namespace penumbra::server {

/// A render on its way. Guarded by the queue's mutex.
struct Job {
  CanonicalRequest request;
  std::set<std::string> wants;  ///< grows while it waits; what joins while it runs is done after
  RenderRecord record;
  std::vector<Submitter> submitters;        ///< those that have not released it
  Priority priority = Priority::anonymous;  ///< the highest of them
  std::string client;                       ///< in whose turn it is taken
  std::string task;  ///< id of what its worker draws: the render itself or its reference
  std::atomic<bool> cancelled = false;
  bool alone = false;  ///< a measurement: nothing else may run beside it
  bool over = false;
  std::condition_variable moved;  ///< status or progress changed
  std::condition_variable ended;  ///< `over` was set
};

/// Jobs of a higher priority first; within one, clients take turns and each one's own come in
/// order. A measurement waits until nothing runs and then runs alone. The queue has no lock of its
/// own: its owner calls under one.
class JobQueue {
 public:
  void push(std::shared_ptr<Job> job);
  /// Before all others of its priority: one that was begun before.
  void push_front(std::shared_ptr<Job> job);

  /// The next job that may run now, marked as running; null where none may.
  std::shared_ptr<Job> take();
  void finished(const Job& job);

  bool remove(const Job& job);
  std::vector<std::shared_ptr<Job>> take_all();

  std::size_t waiting() const;
  std::size_t waiting(Priority priority) const;
  unsigned running() const { return running_; }

 private:
  /// One client's jobs.
  struct Line {
    std::string client;
    std::deque<std::shared_ptr<Job>> jobs;
  };
  using Lines = std::deque<Line>;  ///< the front one's turn is next

  Line& line_of(const Job& job, bool front);

  std::map<Priority, Lines, std::greater<>> waiting_;  ///< no line is empty
  unsigned running_ = 0;
  bool alone_ = false;
};

}  // namespace penumbra::server
