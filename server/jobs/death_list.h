#pragma once

#include <deque>
#include <map>
#include <string>

namespace penumbra::server {

/// How often each picture ended the worker that drew it. One that did so twice is refused until the
/// server is started again: it would do so again, and a breaker that opens stops all others. The
/// list is bounded; its oldest entries are forgotten.
class DeathList {
 public:
  static constexpr unsigned most_deaths = 2;

  /// One more death at the picture; returns how many there are now.
  unsigned add(const std::string& id) {
    const auto [entry, is_new] = deaths_.try_emplace(id, 0);
    if (is_new) order_.push_back(id);
    const unsigned count = ++entry->second;
    while (order_.size() > most_pictures) {
      deaths_.erase(order_.front());
      order_.pop_front();
    }
    return count;
  }

  bool refuses(const std::string& id) const {
    const auto entry = deaths_.find(id);
    return entry != deaths_.end() && entry->second >= most_deaths;
  }

  std::size_t refused() const {
    std::size_t count = 0;
    for (const auto& [id, deaths] : deaths_) count += deaths >= most_deaths;
    return count;
  }

 private:
  static constexpr std::size_t most_pictures = 1024;
  std::map<std::string, unsigned> deaths_;
  std::deque<std::string> order_;
};

}  // namespace penumbra::server
