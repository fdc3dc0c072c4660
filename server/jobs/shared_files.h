#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <unordered_map>

namespace penumbra::server {

/// Bytes of files by name: recent small ones are kept up to a cap, large ones as long as anybody
/// holds them, so that all who send one share a copy. Its owner calls under one lock.
class SharedFiles {
 public:
  static constexpr std::uint64_t largest_kept = std::uint64_t{4} << 20;

  using Bytes = std::shared_ptr<const std::string>;

  Bytes find(const std::string& name);

  /// `whatever_size` keeps a large one as well: it is nowhere else.
  void add(const std::string& name, Bytes bytes, bool whatever_size = false);

  /// Forgets all names that begin with `prefix`.
  void drop(const std::string& prefix);

 private:
  using Kept = std::list<std::pair<std::string, Bytes>>;

  Kept kept_;  ///< most recently used first
  std::unordered_map<std::string, Kept::iterator> index_;
  std::uint64_t bytes_ = 0;
  std::unordered_map<std::string, std::weak_ptr<const std::string>> held_;  ///< large ones
};

}  // namespace penumbra::server
