#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_map>

#include "server/jobs/message.h"

namespace penumbra::server {

/// Files of finished renders by id, on disk and the recent small ones in memory. Every file is
/// verified against the digest in its record before it is handed out; what fails is forgotten, to
/// be drawn again. Least recently used renders go when the files exceed the cap. Thread-safe, and
/// several programs may share a folder.
///
/// FOLDER/ab/abcd.../record.json and files; FOLDER/new/ holds files under way, swept at start.
class ArtefactStore {
 public:
  ArtefactStore(std::filesystem::path folder, std::uint64_t cap_bytes);

  /// What was stored beside the files, or null for an unknown id.
  nlohmann::json find(const std::string& id);

  /// True where a file of that name was stored; it may yet prove damaged.
  bool has(const std::string& id, const std::string& name);

  /// Verified bytes, or null.
  std::shared_ptr<const std::string> read(const std::string& id, const std::string& name);

  /// Replaces the record and adds files to those that are there. A full or failing disk is counted,
  /// not thrown: the render then lives in memory as long as there is room.
  void put(const std::string& id, const nlohmann::json& record, const Blobs& files);

  void forget(const std::string& id);

  struct Statistics {
    std::uint64_t renders = 0;
    std::uint64_t bytes = 0;
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
  struct Entry {
    bool loaded = false;  ///< record and files are known, not only that they exist
    nlohmann::json record;
    std::map<std::string, File> files;
    std::uint64_t bytes = 0;  ///< on disk
    std::list<std::string>::iterator use;
  };
  using Entries = std::unordered_map<std::string, Entry>;
  using Hot = std::list<std::pair<std::string, std::shared_ptr<const std::string>>>;

  std::filesystem::path folder_of(const std::string& id) const;
  void scan();
  Entry* touch(const std::string& id);
  bool load(const std::string& id, Entry& entry);
  void drop(const std::string& id);
  void keep_hot(const std::string& key, std::shared_ptr<const std::string> bytes,
                std::uint64_t largest);
  void drop_hot(const std::string& id);
  void evict();
  bool write_files(const std::string& id, const nlohmann::json& stored, const Blobs& files);

  std::filesystem::path folder_;
  std::uint64_t cap_bytes_;
  std::mutex mutex_;
  Entries entries_;
  std::list<std::string> uses_;  ///< ids, most recently used first
  Hot hot_;                      ///< "id/name" and bytes, most recently used first
  std::unordered_map<std::string, Hot::iterator> hot_index_;
  std::uint64_t hot_bytes_ = 0;
  std::uint64_t bytes_ = 0;
  std::uint64_t counter_ = 0;  ///< of names of files under way
  Statistics statistics_;
};

}  // namespace penumbra::server
