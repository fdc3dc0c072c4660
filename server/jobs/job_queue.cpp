#include "server/jobs/job_queue.h"

#include <algorithm>

namespace penumbra::server {

JobQueue::Line& JobQueue::line_of(const Job& job, bool front) {
  Lines& lines = waiting_[job.priority];
  auto line = std::find_if(lines.begin(), lines.end(),
                           [&](const Line& each) { return each.client == job.client; });
  if (line == lines.end())
    line = lines.insert(front ? lines.begin() : lines.end(), {job.client, {}});
  if (front && line != lines.begin()) {
    std::rotate(lines.begin(), line, line + 1);
    line = lines.begin();
  }
  return *line;
}

void JobQueue::push(std::shared_ptr<Job> job) {
  line_of(*job, false).jobs.push_back(job);
}

void JobQueue::push_front(std::shared_ptr<Job> job) {
  line_of(*job, true).jobs.push_front(job);
}

std::shared_ptr<Job> JobQueue::take() {
  if (alone_) return nullptr;
  for (auto& [priority, lines] : waiting_) {
    if (lines.empty()) continue;
    if (lines.front().jobs.front()->alone && running_ > 0) return nullptr;
    Line line = std::move(lines.front());
    lines.pop_front();
    std::shared_ptr<Job> job = std::move(line.jobs.front());
    line.jobs.pop_front();
    if (!line.jobs.empty()) lines.push_back(std::move(line));
    ++running_;
    alone_ = job->alone;
    return job;
  }
  return nullptr;
}

void JobQueue::finished(const Job&) {
  --running_;
  alone_ = false;
}

bool JobQueue::remove(const Job& job) {
  for (auto& [priority, lines] : waiting_) {
    for (auto line = lines.begin(); line != lines.end(); ++line) {
      const auto found = std::find_if(line->jobs.begin(), line->jobs.end(),
                                      [&](const auto& each) { return each.get() == &job; });
      if (found == line->jobs.end()) continue;
      line->jobs.erase(found);
      if (line->jobs.empty()) lines.erase(line);
      return true;
    }
  }
  return false;
}

std::vector<std::shared_ptr<Job>> JobQueue::take_all() {
  std::vector<std::shared_ptr<Job>> all;
  for (auto& [priority, lines] : std::exchange(waiting_, {}))
    for (Line& line : lines)
      for (std::shared_ptr<Job>& job : line.jobs) all.push_back(std::move(job));
  return all;
}

std::size_t JobQueue::waiting() const {
  std::size_t count = 0;
  for (const auto& [priority, lines] : waiting_) count += waiting(priority);
  return count;
}

std::size_t JobQueue::waiting(Priority priority) const {
  const auto lines = waiting_.find(priority);
  if (lines == waiting_.end()) return 0;
  std::size_t count = 0;
  for (const Line& line : lines->second) count += line.jobs.size();
  return count;
}

}  // namespace penumbra::server
