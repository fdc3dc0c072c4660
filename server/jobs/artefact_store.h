#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "server/jobs/message.h"
#include "server/jobs/shared_files.h"

namespace penumbra::server {

/// Files of finished renders by id, on disk and the recent small ones in memory. Every file is
/// verified against the digest in its record before it is handed out; what fails is forgotten, to
/// be drawn again. Least recently used renders go when the blocks on disk exceed the cap, or there
/// are too many of them. Thread-safe, and several programs may share a folder. Nothing is read,
/// hashed or removed under its mutex.
///
/// FOLDER/ab/abcd.../record.json and files; FOLDER/new/ holds files under way, swept at start.
class ArtefactStore {
 public:
  /// What it keeps at most.
  struct Caps {
    std::uint64_t bytes = 4ull << 30;    ///< blocks on disk
    std::size_t renders = 100'000;       ///< each takes some hundred bytes of memory
    std::size_t loaded_records = 2'048;  ///< held in memory, some kilobytes each
  };
  ArtefactStore(std::filesystem::path folder, const Caps& caps);
  ArtefactStore(std::filesystem::path folder, std::uint64_t cap_bytes)
      : ArtefactStore(std::move(folder), Caps{.bytes = cap_bytes}) {}

  /// What was stored beside the files, or null for an unknown id.
  nlohmann::json find(const std::string& id);

  /// True where a file of that name was stored; it may yet prove damaged.
  bool has(const std::string& id, const std::string& name);

  /// Verified bytes, or null. Readers at the same time share one copy.
  std::shared_ptr<const std::string> read(const std::string& id, const std::string& name);

  /// Replaces the record and adds files to those that are there. A full or failing disk is counted,
  /// not thrown: the render then lives in memory as long as there is room.
  void put(const std::string& id, const nlohmann::json& record, const Blobs& files);

  void forget(const std::string& id);

  struct Statistics {
    std::uint64_t renders = 0;
    std::uint64_t loaded = 0;  ///< records held in memory
    std::uint64_t bytes = 0;   ///< blocks on disk
    std::uint64_t damaged = 0;
    std::uint64_t evicted = 0;
    std::uint64_t write_failures = 0;
  };
  Statistics statistics();

 private:
  struct File {
    std::uint64_t bytes = 0;
    std::string sha256;
  };
  /// A record and the files that it names.
  struct Content {
    nlohmann::json record;
    std::map<std::string, File> files;
  };
  struct Entry {
    std::optional<Content> content;  ///< empty: on disk only
    std::uint64_t bytes = 0;         ///< on disk
    std::list<std::string>::iterator use;
    std::list<std::string>::iterator load;  ///< where `content` is
  };
  using Entries = std::unordered_map<std::string, Entry>;
  using Lock = std::unique_lock<std::mutex>;

  std::filesystem::path folder_of(const std::string& id) const;
  std::filesystem::path temporary();  ///< a new name; under the mutex
  void scan();
  Content* touch(Lock& lock, const std::string& id);
  Entry& entry_of(const std::string& id);
  void keep(const std::string& id, Entry& entry, Content content);
  void unload(Entry& entry);
  void drop(Lock& lock, const std::string& id);
  void set_aside(const std::string& id, std::vector<std::filesystem::path>& aside);
  void evict(Lock& lock);
  bool write_files(const std::string& id, const nlohmann::json& stored, const Blobs& files);

  std::filesystem::path folder_;
  Caps caps_;
  std::mutex mutex_;
  Entries entries_;
  std::list<std::string> uses_;   ///< ids, most recently used first
  std::list<std::string> loads_;  ///< of those whose record is in memory, most recently used first
  SharedFiles shared_;
  std::condition_variable read_;   ///< a file was read
  std::set<std::string> reading_;  ///< "id/name" of files that are being read
  std::uint64_t bytes_ = 0;
  std::uint64_t counter_ = 0;  ///< of names of files under way
  Statistics statistics_;
};

}  // namespace penumbra::server
