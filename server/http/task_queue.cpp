#include "server/http/task_queue.h"

#include <chrono>
#include <system_error>
#include <thread>

namespace penumbra::server::http {

void ElasticTaskQueue::enqueue(std::function<void()> task) {
  const std::lock_guard lock(mutex);
  tasks.push_back(std::move(task));
  if (idle >= tasks.size() || threads >= most) {
    task_added.notify_one();
    return;
  }
  try {
    std::thread([this] { work(); }).detach();
    ++threads;
  } catch (const std::system_error&) {
    task_added.notify_one();  // no more threads to be had: the ones there are take it
  }
}

void ElasticTaskQueue::work() {
  constexpr auto patience = std::chrono::seconds(10);
  std::unique_lock lock(mutex);
  while (true) {
    ++idle;
    const bool woken =
        task_added.wait_for(lock, patience, [&] { return stopping || !tasks.empty(); });
    --idle;
    if (tasks.empty() && (stopping || !woken)) break;
    const auto task = std::move(tasks.front());
    tasks.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
  --threads;
  // Under the lock: the queue is destroyed as soon as the last thread is seen to be gone.
  thread_ended.notify_all();
}

void ElasticTaskQueue::shutdown() {
  std::unique_lock lock(mutex);
  stopping = true;
  task_added.notify_all();
  thread_ended.wait(lock, [&] { return threads == 0; });
}

}  // namespace penumbra::server::http
