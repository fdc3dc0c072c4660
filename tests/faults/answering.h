#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "tests/faults/people.h"

namespace penumbra::faults {

/// People who answer on threads of their own, each a page once, until there is none left or `stop`.
/// A page that was not acknowledged is sent again under the same id until it is.
class Answering {
 public:
  Answering(const ServerProcess& server, std::vector<Person> people, int threads);
  ~Answering() { stop(); }

  /// Lets running calls end.
  void stop();
  /// Waits for every page of everybody.
  void finish();

  const Acknowledged& acknowledged() const { return acknowledged_; }
  int retried() const { return retried_; }        ///< calls without a reply or refused for a while
  int refused() const { return refused_; }        ///< 503s among them
  int unexpected() const { return unexpected_; }  ///< states that are neither 200 nor 503
  std::vector<double> seconds() const;            ///< of acknowledged calls

 private:
  void run();
  void send(httplib::Client& client, const Person& person, std::size_t page);

  const ServerProcess& server_;
  std::vector<Person> people_;
  std::atomic<std::size_t> next_ = 0;  ///< person and page in one number
  std::atomic<bool> stopping_ = false;
  std::atomic<int> retried_ = 0;
  std::atomic<int> refused_ = 0;
  std::atomic<int> unexpected_ = 0;
  Acknowledged acknowledged_;
  mutable std::mutex mutex_;
  std::vector<double> seconds_;
  std::vector<std::thread> threads_;
};

/// People who enter the study.
std::vector<Person> enter_many(const ServerProcess& server, int count);

}  // namespace penumbra::faults
