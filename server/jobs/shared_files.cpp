#include "server/jobs/shared_files.h"

namespace penumbra::server {
namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{128} << 20;

}  // namespace

SharedFiles::Bytes SharedFiles::find(const std::string& name) {
  if (const auto kept = index_.find(name); kept != index_.end()) {
    kept_.splice(kept_.begin(), kept_, kept->second);
    return kept->second->second;
  }
  const auto held = held_.find(name);
  return held == held_.end() ? nullptr : held->second.lock();
}

void SharedFiles::add(const std::string& name, Bytes bytes, bool whatever_size) {
  if (index_.contains(name)) return;
  if (bytes->size() > largest_kept && !whatever_size) {
    std::erase_if(held_, [](const auto& entry) { return entry.second.expired(); });
    held_[name] = std::move(bytes);
    return;
  }
  bytes_ += bytes->size();
  kept_.emplace_front(name, std::move(bytes));
  index_[name] = kept_.begin();
  while (bytes_ > most_bytes) {
    bytes_ -= kept_.back().second->size();
    index_.erase(kept_.back().first);
    kept_.pop_back();
  }
}

void SharedFiles::drop(const std::string& prefix) {
  std::erase_if(held_, [&](const auto& entry) { return entry.first.starts_with(prefix); });
  for (auto kept = kept_.begin(); kept != kept_.end();) {
    if (kept->first.starts_with(prefix)) {
      bytes_ -= kept->second->size();
      index_.erase(kept->first);
      kept = kept_.erase(kept);
    } else {
      ++kept;
    }
  }
}

}  // namespace penumbra::server
