#pragma once

#include <httplib.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

namespace penumbra::server::http {

/// Threads as they are needed: a connection occupies one as long as it is kept open, so a fixed few
/// would let idle clients keep others out. Threads end after some idle seconds; connections beyond
/// `most` wait.
class ElasticTaskQueue : public httplib::TaskQueue {
 public:
  explicit ElasticTaskQueue(std::size_t most_) : most(most_) {}
  void enqueue(std::function<void()> task) override;
  void shutdown() override;  ///< returns when every task is over

 private:
  void work();

  std::size_t most;
  std::mutex mutex;
  std::condition_variable task_added;
  std::condition_variable thread_ended;
  std::deque<std::function<void()>> tasks;
  std::size_t threads = 0;
  std::size_t idle = 0;
  bool stopping = false;
};

}  // namespace penumbra::server::http
