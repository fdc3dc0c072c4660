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
#include "server/files/digest.h"
#include "server/files/durable_file.h"

namespace penumbra::server {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr auto record_name = "record.json";
constexpr auto under_way = "new";
constexpr std::time_t touch_every_s = 60;  ///< the time of use survives restarts this coarsely

bool is_id(const std::string& text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// A record with the digest of its own text and id, so that damage to it shows as well, and so does
/// the whole record of another render in its place.
std::string digest_of(const std::string& id, const json& stored) {
  return sha256(id + scenes::json_text(stored));
}

std::string sealed(const std::string& id, const json& stored) {
  return scenes::json_text(json{{"sha256", digest_of(id, stored)}, {"stored", stored}});
}

json unsealed(const std::string& id, const std::string& text) {
  const json outer = json::parse(text, nullptr, false);
  if (!outer.is_object() || !outer.contains("sha256") || !outer.contains("stored")) return nullptr;
  if (outer["sha256"] != digest_of(id, outer["stored"])) return nullptr;
  return outer["stored"];
}

/// Bytes that a file or folder takes on its disk: whole blocks, many times the length of small
/// ones.
std::uint64_t blocks_of(const fs::path& path) {
  constexpr std::uint64_t block = 512;  // of st_blocks, whatever the file system's own are
  struct stat about {};
  if (::lstat(path.c_str(), &about) != 0) return 0;
  const auto length = S_ISREG(about.st_mode) ? static_cast<std::uint64_t>(about.st_size) : 0;
  return std::max(static_cast<std::uint64_t>(about.st_blocks) * block, length);
}

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = blocks_of(folder);
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder, error)) bytes += blocks_of(file.path());
  return bytes;
}

}  // namespace

ArtefactStore::ArtefactStore(fs::path folder, const Caps& caps)
    : folder_(std::move(folder)), caps_(caps) {
  fs::create_directories(folder_ / under_way);
  scan();
}

fs::path ArtefactStore::folder_of(const std::string& id) const {
  return folder_ / id.substr(0, 2) / id;
}

void ArtefactStore::scan() {
  // Remove what writers that died left behind.
  for (const auto& left_over : fs::directory_iterator(folder_ / under_way)) {
    const pid_t writer = std::atoi(left_over.path().filename().c_str());
    if (writer <= 0 || (::kill(writer, 0) != 0 && errno == ESRCH)) {
      std::error_code ignored;
      fs::remove_all(left_over.path(), ignored);
    }
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
  Lock lock(mutex_);
  evict(lock);
}

fs::path ArtefactStore::temporary() {
  return folder_ / under_way / (std::to_string(::getpid()) + "-" + std::to_string(++counter_));
}

ArtefactStore::Entry& ArtefactStore::entry_of(const std::string& id) {
  const auto [found, is_new] = entries_.try_emplace(id);
  if (is_new) {
    uses_.push_front(id);
    found->second.use = uses_.begin();
  }
  return found->second;
}

void ArtefactStore::keep(const std::string& id, Entry& entry, Content content) {
  if (!entry.content) {
    loads_.push_front(id);
    entry.load = loads_.begin();
  }
  entry.content = std::move(content);
  while (loads_.size() > caps_.loaded_records) unload(entries_.at(loads_.back()));
}

void ArtefactStore::unload(Entry& entry) {
  if (!entry.content) return;
  loads_.erase(entry.load);
  entry.content.reset();
}

/// The content of an entry, now the one used last; null where there is none, or it is damaged. It
/// may be read from disk, without the lock; what is returned is valid while the lock is held.
ArtefactStore::Content* ArtefactStore::touch(Lock& lock, const std::string& id) {
  if (!is_id(id)) return nullptr;
  if (const auto found = entries_.find(id); found == entries_.end() || !found->second.content) {
    const bool known = found != entries_.end();
    lock.unlock();
    // Another program may share the folder and have drawn it meanwhile.
    const fs::path path = folder_of(id) / record_name;
    const auto text = read_whole(path);
    const json stored = text ? unsealed(id, *text) : json(nullptr);
    const std::uint64_t bytes = text && !known ? bytes_in(folder_of(id)) : 0;
    struct stat about {};
    if (text && ::stat(path.c_str(), &about) == 0 &&
        std::time(nullptr) - about.st_mtime > touch_every_s)
      ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
    lock.lock();
    const auto now = entries_.find(id);
    const bool loaded = now != entries_.end() && now->second.content;  // by another meanwhile
    if (!loaded && stored.is_null()) {
      if (text || known) {
        ++statistics_.damaged;
        drop(lock, id);
      }
      return nullptr;
    }
    if (!loaded) {
      Content content{stored.at("record"), {}};
      for (const auto& [name, file] : stored.at("files").items())
        content.files[name] = {file.at("bytes"), file.at("sha256")};
      Entry& entry = entry_of(id);
      if (now == entries_.end()) {
        entry.bytes = bytes;
        bytes_ += bytes;
      }
      keep(id, entry, std::move(content));
    }
  }
  Entry& entry = entries_.at(id);
  uses_.splice(uses_.begin(), uses_, entry.use);
  loads_.splice(loads_.begin(), loads_, entry.load);
  return &*entry.content;
}

json ArtefactStore::find(const std::string& id) {
  Lock lock(mutex_);
  const Content* content = touch(lock, id);
  return content ? content->record : json(nullptr);
}

bool ArtefactStore::has(const std::string& id, const std::string& name) {
  Lock lock(mutex_);
  const Content* content = touch(lock, id);
  return content && content->files.contains(name);
}

std::shared_ptr<const std::string> ArtefactStore::read(const std::string& id,
                                                       const std::string& name) {
  const std::string key = id + "/" + name;
  Lock lock(mutex_);
  while (true) {
    const Content* content = touch(lock, id);
    if (!content || !content->files.contains(name)) return nullptr;
    if (auto bytes = shared_.find(key)) return bytes;
    if (reading_.insert(key).second) break;
    read_.wait(lock);  // for another's copy of it
  }
  const File expected = entries_.at(id).content->files.at(name);
  lock.unlock();
  std::optional<std::string> text;
  bool sound = false;
  try {
    text = read_whole(folder_of(id) / name);
    sound = text && text->size() == expected.bytes && sha256(*text) == expected.sha256;
  } catch (...) {
    lock.lock();
    reading_.erase(key);
    read_.notify_all();
    throw;  // out of memory
  }
  lock.lock();
  reading_.erase(key);
  read_.notify_all();
  if (!sound) {
    // It may have been written anew meanwhile; then this reader was merely late.
    Content* content = touch(lock, id);
    if (content && content->files.contains(name) &&
        content->files.at(name).sha256 == expected.sha256) {
      ++statistics_.damaged;
      content->files.erase(name);
    }
    return nullptr;
  }
  auto bytes = std::make_shared<const std::string>(std::move(*text));
  shared_.add(key, bytes);
  return bytes;
}

void ArtefactStore::put(const std::string& id, const json& record, const Blobs& files) {
  std::map<std::string, File> fresh;
  for (const auto& [name, bytes] : files) fresh[name] = {bytes.size(), sha256(bytes)};
  json list = json::object();
  {
    Lock lock(mutex_);
    Content content;
    if (const Content* old = touch(lock, id)) content = *old;
    content.record = record;
    for (const auto& [name, file] : fresh) {
      content.files[name] = file;
      shared_.drop(id + "/" + name);
    }
    for (const auto& [name, file] : content.files)
      list[name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
    keep(id, entry_of(id), std::move(content));
  }

  const bool written = write_files(id, {{"record", record}, {"files", list}}, files);
  const std::uint64_t bytes = bytes_in(folder_of(id));
  Lock lock(mutex_);
  if (!written) ++statistics_.write_failures;
  // Whatever the disk does, the picture is delivered.
  for (const auto& [name, content] : files)
    if (!written || content.size() <= SharedFiles::largest_kept)
      shared_.add(id + "/" + name, std::make_shared<const std::string>(content), !written);
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return;
  bytes_ += bytes - entry->second.bytes;
  entry->second.bytes = bytes;
  evict(lock);
}

bool ArtefactStore::write_files(const std::string& id, const json& stored, const Blobs& files) {
  const auto new_name = [this] {
    const std::lock_guard lock(mutex_);
    return temporary();
  };
  try {
    fs::create_directories(folder_of(id));
    for (const auto& [name, bytes] : files) write_durably(folder_of(id) / name, new_name(), bytes);
    write_durably(folder_of(id) / record_name, new_name(), sealed(id, stored));
    return true;
  } catch (const std::system_error&) {
    return false;
  }
}

void ArtefactStore::forget(const std::string& id) {
  Lock lock(mutex_);
  drop(lock, id);
}

/// Forgets an entry and moves its folder away, so that it can be removed without the lock while
/// another is written in its place.
void ArtefactStore::set_aside(const std::string& id, std::vector<fs::path>& aside) {
  if (const auto entry = entries_.find(id); entry != entries_.end()) {
    bytes_ -= entry->second.bytes;
    uses_.erase(entry->second.use);
    unload(entry->second);
    entries_.erase(entry);
  }
  shared_.drop(id);
  const fs::path place = temporary();
  if (::rename(folder_of(id).c_str(), place.c_str()) == 0) aside.push_back(place);
}

void ArtefactStore::drop(Lock& lock, const std::string& id) {
  std::vector<fs::path> aside;
  set_aside(id, aside);
  lock.unlock();
  std::error_code error;
  for (const fs::path& place : aside) fs::remove_all(place, error);
  lock.lock();
}

void ArtefactStore::evict(Lock& lock) {
  std::vector<fs::path> aside;
  // The one used last stays, however large: it is being delivered.
  while ((bytes_ > caps_.bytes || uses_.size() > caps_.renders) && uses_.size() > 1) {
    set_aside(std::string(uses_.back()), aside);
    ++statistics_.evicted;
  }
  lock.unlock();
  std::error_code error;
  for (const fs::path& place : aside) fs::remove_all(place, error);
  lock.lock();
}

ArtefactStore::Statistics ArtefactStore::statistics() {
  const std::lock_guard lock(mutex_);
  Statistics now = statistics_;
  now.renders = entries_.size();
  now.loaded = loads_.size();
  now.bytes = bytes_;
  return now;
}

}  // namespace penumbra::server
