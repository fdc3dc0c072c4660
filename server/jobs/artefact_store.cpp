#include "server/jobs/artefact_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <system_error>
#include <vector>

#include "scenes/json_text.h"
#include "server/jobs/digest.h"
#include "server/jobs/durable_file.h"

namespace penumbra::server {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr std::uint64_t hot_cap_bytes = std::uint64_t{128} << 20;
constexpr std::uint64_t hot_file_bytes = std::uint64_t{4} << 20;  ///< larger files stay on disk
constexpr auto record_name = "record.json";
constexpr auto under_way = "new";
constexpr std::time_t touch_every_s = 60;  ///< the time of use survives restarts this coarsely

bool is_id(const std::string& text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// A record with the digest of its own text, so that damage to it shows as well.
std::string sealed(const json& stored) {
  return scenes::json_text(json{{"sha256", sha256(scenes::json_text(stored))}, {"stored", stored}});
}

json unsealed(const std::string& text) {
  const json outer = json::parse(text, nullptr, false);
  if (!outer.is_object() || !outer.contains("sha256") || !outer.contains("stored")) return nullptr;
  if (outer["sha256"] != sha256(scenes::json_text(outer["stored"]))) return nullptr;
  return outer["stored"];
}

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder, error)) {
    const std::uintmax_t size = file.file_size(error);
    if (!error) bytes += size;
  }
  return bytes;
}

}  // namespace

ArtefactStore::ArtefactStore(fs::path folder, std::uint64_t cap_bytes)
    : folder_(std::move(folder)), cap_bytes_(cap_bytes) {
  fs::create_directories(folder_ / under_way);
  scan();
}

fs::path ArtefactStore::folder_of(const std::string& id) const {
  return folder_ / id.substr(0, 2) / id;
}

void ArtefactStore::scan() {
  // What was being written when the power went is nobody's.
  for (const auto& left_over : fs::directory_iterator(folder_ / under_way)) {
    const pid_t writer = std::atoi(left_over.path().filename().c_str());
    if (writer <= 0 || (::kill(writer, 0) != 0 && errno == ESRCH)) fs::remove_all(left_over.path());
  }

  struct Found {
    std::string id;
    std::uint64_t bytes;
    fs::file_time_type used;
  };
  std::vector<Found> found;
  for (const auto& shelf : fs::directory_iterator(folder_)) {
    if (!shelf.is_directory() || shelf.path().filename() == under_way) continue;
    for (const auto& place : fs::directory_iterator(shelf.path())) {
      const std::string id = place.path().filename().string();
      std::error_code error;
      const auto used = fs::last_write_time(place.path() / record_name, error);
      if (!is_id(id) || error) {
        fs::remove_all(place.path(), error);
        continue;
      }
      found.push_back({id, bytes_in(place.path()), used});
    }
  }
  std::sort(found.begin(), found.end(),
            [](const Found& a, const Found& b) { return a.used > b.used; });
  for (const Found& one : found) {
    uses_.push_back(one.id);
    Entry& entry = entries_[one.id];
    entry.bytes = one.bytes;
    entry.use = std::prev(uses_.end());
    bytes_ += one.bytes;
  }
  evict();
}

ArtefactStore::Entry* ArtefactStore::touch(const std::string& id) {
  auto found = entries_.find(id);
  if (found == entries_.end()) {
    // Another program may share the folder and have drawn it meanwhile.
    if (!is_id(id) || ::access((folder_of(id) / record_name).c_str(), R_OK) != 0) return nullptr;
    found = entries_.try_emplace(id).first;
    uses_.push_front(id);
    found->second.use = uses_.begin();
    found->second.bytes = bytes_in(folder_of(id));
    bytes_ += found->second.bytes;
  }
  Entry& entry = found->second;
  if (!entry.loaded && !load(id, entry)) {
    drop(id);
    return nullptr;
  }
  uses_.splice(uses_.begin(), uses_, entry.use);
  return &entry;
}

bool ArtefactStore::load(const std::string& id, Entry& entry) {
  const fs::path path = folder_of(id) / record_name;
  const auto text = read_whole(path);
  const json stored = text ? unsealed(*text) : json(nullptr);
  if (stored.is_null()) {
    ++statistics_.damaged;
    return false;
  }
  entry.record = stored.at("record");
  for (const auto& [name, file] : stored.at("files").items())
    entry.files[name] = {file.at("bytes"), file.at("sha256")};
  entry.loaded = true;

  struct stat about {};
  if (::stat(path.c_str(), &about) == 0 && std::time(nullptr) - about.st_mtime > touch_every_s)
    ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
  return true;
}

json ArtefactStore::find(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const Entry* entry = touch(id);
  return entry ? entry->record : json(nullptr);
}

bool ArtefactStore::has(const std::string& id, const std::string& name) {
  const std::lock_guard lock(mutex_);
  const Entry* entry = touch(id);
  return entry && entry->files.contains(name);
}

std::shared_ptr<const std::string> ArtefactStore::read(const std::string& id,
                                                       const std::string& name) {
  const std::string key = id + "/" + name;
  File expected;
  {
    const std::lock_guard lock(mutex_);
    const Entry* entry = touch(id);
    if (!entry) return nullptr;
    const auto file = entry->files.find(name);
    if (file == entry->files.end()) return nullptr;
    if (const auto hot = hot_index_.find(key); hot != hot_index_.end()) {
      hot_.splice(hot_.begin(), hot_, hot->second);
      return hot->second->second;
    }
    expected = file->second;
  }

  // Reading and hashing go on beside other requests.
  auto text = read_whole(folder_of(id) / name);
  const bool sound = text && text->size() == expected.bytes && sha256(*text) == expected.sha256;
  const std::lock_guard lock(mutex_);
  if (!sound) {
    const auto entry = entries_.find(id);
    // Somebody may have written it anew meanwhile; then this reader was merely late.
    if (entry != entries_.end() && entry->second.files[name].sha256 == expected.sha256) {
      ++statistics_.damaged;
      entry->second.files.erase(name);
    }
    return nullptr;
  }
  auto bytes = std::make_shared<const std::string>(std::move(*text));
  keep_hot(key, bytes, hot_file_bytes);
  return bytes;
}

void ArtefactStore::put(const std::string& id, const json& record, const Blobs& files) {
  json list = json::object();
  {
    const std::lock_guard lock(mutex_);
    Entry* entry = touch(id);
    if (!entry) {
      uses_.push_front(id);
      entry = &entries_[id];
      entry->use = uses_.begin();
      entry->loaded = true;
    }
    entry->record = record;
    for (const auto& [name, bytes] : files) {
      entry->files[name] = {bytes.size(), sha256(bytes)};
      if (hot_index_.contains(id + "/" + name)) drop_hot(id);
      keep_hot(id + "/" + name, std::make_shared<const std::string>(bytes), hot_file_bytes);
    }
    for (const auto& [name, file] : entry->files)
      list[name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  }

  const bool written = write_files(id, {{"record", record}, {"files", list}}, files);
  const std::lock_guard lock(mutex_);
  if (!written) {
    // Whatever the disk does, the picture is delivered.
    ++statistics_.write_failures;
    for (const auto& [name, bytes] : files)
      keep_hot(id + "/" + name, std::make_shared<const std::string>(bytes), hot_cap_bytes);
  }
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return;
  bytes_ -= entry->second.bytes;
  entry->second.bytes = bytes_in(folder_of(id));
  bytes_ += entry->second.bytes;
  evict();
}

bool ArtefactStore::write_files(const std::string& id, const json& stored, const Blobs& files) {
  const auto temporary = [this] {
    const std::lock_guard lock(mutex_);
    return folder_ / under_way / (std::to_string(::getpid()) + "-" + std::to_string(++counter_));
  };
  try {
    fs::create_directories(folder_of(id));
    for (const auto& [name, bytes] : files) write_durably(folder_of(id) / name, temporary(), bytes);
    write_durably(folder_of(id) / record_name, temporary(), sealed(stored));
    return true;
  } catch (const std::system_error&) {
    return false;
  }
}

void ArtefactStore::forget(const std::string& id) {
  const std::lock_guard lock(mutex_);
  drop(id);
}

void ArtefactStore::drop(const std::string& id) {
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return;
  bytes_ -= entry->second.bytes;
  uses_.erase(entry->second.use);
  entries_.erase(entry);
  drop_hot(id);
  std::error_code error;
  fs::remove_all(folder_of(id), error);
}

void ArtefactStore::keep_hot(const std::string& key, std::shared_ptr<const std::string> bytes,
                             std::uint64_t largest) {
  if (bytes->size() > largest || hot_index_.contains(key)) return;
  hot_bytes_ += bytes->size();
  hot_.emplace_front(key, std::move(bytes));
  hot_index_[key] = hot_.begin();
  while (hot_bytes_ > hot_cap_bytes) {
    hot_bytes_ -= hot_.back().second->size();
    hot_index_.erase(hot_.back().first);
    hot_.pop_back();
  }
}

void ArtefactStore::drop_hot(const std::string& id) {
  for (auto hot = hot_.begin(); hot != hot_.end();) {
    if (hot->first.compare(0, id.size(), id) == 0) {
      hot_bytes_ -= hot->second->size();
      hot_index_.erase(hot->first);
      hot = hot_.erase(hot);
    } else {
      ++hot;
    }
  }
}

void ArtefactStore::evict() {
  // The one used last stays, however large: it is being delivered.
  while (bytes_ > cap_bytes_ && uses_.size() > 1) {
    const std::string oldest = uses_.back();
    drop(oldest);
    ++statistics_.evicted;
  }
}

ArtefactStore::Statistics ArtefactStore::statistics() {
  const std::lock_guard lock(mutex_);
  Statistics now = statistics_;
  now.renders = entries_.size();
  now.bytes = bytes_;
  return now;
}

}  // namespace penumbra::server
