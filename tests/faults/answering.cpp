#include "tests/faults/answering.h"

#include <algorithm>

namespace penumbra::faults {

Answering::Answering(const ServerProcess& server, std::vector<Person> people, int threads)
    : server_(server), people_(std::move(people)) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
}

void Answering::stop() {
  stopping_ = true;
  finish();
}

void Answering::finish() {
  for (auto& thread : threads_)
    if (thread.joinable()) thread.join();
}

std::vector<double> Answering::seconds() const {
  const std::lock_guard lock(mutex_);
  auto sorted = seconds_;
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

void Answering::run() {
  auto client = server_.client();
  client.set_read_timeout(20);
  while (!stopping_) {
    const std::size_t number = next_++;
    const std::size_t pages = people_.empty() ? 1 : people_.front().pages.size();
    if (number >= people_.size() * pages) return;
    // Everybody's first page before anybody's second: one person's calls are not in a row.
    send(client, people_[number % people_.size()], number / people_.size());
  }
}

void Answering::send(httplib::Client& client, const Person& person, std::size_t page) {
  const auto id = random_uuid();
  const auto body = person.answer(page, id).dump();
  while (!stopping_) {
    const Stopwatch watch;
    const auto result = client.Put(person.page(page), body, "application/json");
    const double took = watch.seconds();
    if (result && result->status == 200) {
      acknowledged_.add(person, page, id, result->body);
      const std::lock_guard lock(mutex_);
      seconds_.push_back(took);
      return;
    }
    ++retried_;
    if (result && result->status == 503) ++refused_;
    if (result && result->status != 503) {
      ++unexpected_;
      ADD_FAILURE() << result->status << " " << result->body;
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

std::vector<Person> enter_many(const ServerProcess& server, int count) {
  std::vector<Person> people;
  auto client = server.client();
  for (int i = 0; i < count; ++i) people.push_back(enter(client));
  EXPECT_FALSE(people.back().token.empty());
  return people;
}

}  // namespace penumbra::faults
