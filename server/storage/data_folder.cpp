#include "server/storage/data_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "renderer/error.h"
#include "server/storage/folder_files.h"

namespace penumbra::server::storage {
namespace {

Error storage_error(const std::string& doing, const std::filesystem::path& file) {
  return {"storage", doing + " " + file.string() + ": " + std::strerror(errno)};
}

constexpr const char* unfinished = ".part";  // in the names of files being written

/// Closes a descriptor at the end of its block.
struct Descriptor {
  int value;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

}  // namespace

DataFolder::DataFolder(std::filesystem::path path) : root(std::move(path)) {
  std::error_code failure;
  if (!std::filesystem::exists(root, failure)) {
    std::filesystem::create_directories(root.parent_path(), failure);
    try {
      make_private_folder(root);
    } catch (const Error& error) {
      throw bad_value("data", error.what());
    }
  }
  const auto file = root / "lock";
  lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock < 0) throw storage_error("cannot open", file);
  if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock);
    lock = -1;
    throw Error("conflict", "another process uses the data folder " + root.string(), "data");
  }
}

DataFolder::~DataFolder() {
  if (lock >= 0) ::close(lock);
}

void make_private_folder(const std::filesystem::path& folder) {
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    throw storage_error("cannot create", folder);
  if (::chmod(folder.c_str(), 0700) != 0) throw storage_error("cannot close to others", folder);
}

void sweep_unfinished(const std::filesystem::path& folder) {
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure))
    if (entry.path().filename().string().find(unfinished) != std::string::npos)
      std::filesystem::remove(entry.path(), failure);
}

void sweep_leftovers(const std::filesystem::path& data) {
  sweep_unfinished(data);
  std::error_code failure;
  for (const char* name : {incoming_name, exports_name})
    for (const auto& entry : std::filesystem::directory_iterator(data / name, failure))
      std::filesystem::remove_all(entry.path(), failure);
}

void write_file_durably(const std::filesystem::path& file, const std::string& bytes,
                        unsigned mode) {
  static std::atomic<unsigned> counter{0};
  const auto temporary = file.string() + unfinished + std::to_string(::getpid()) + "-" +
                         std::to_string(counter.fetch_add(1));
  {
    Descriptor out{::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode)};
    if (out.value < 0) throw storage_error("cannot create", temporary);
    for (std::size_t done = 0; done < bytes.size();) {
      const auto written = ::write(out.value, bytes.data() + done, bytes.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) {
        const Error error = storage_error("cannot write", temporary);
        ::unlink(temporary.c_str());
        throw error;
      }
      done += static_cast<std::size_t>(written);
    }
    if (::fsync(out.value) != 0) {
      const Error error = storage_error("cannot sync", temporary);
      ::unlink(temporary.c_str());
      throw error;
    }
  }
  if (::rename(temporary.c_str(), file.c_str()) != 0) throw storage_error("cannot rename to", file);
  Descriptor folder{::open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (folder.value < 0 || ::fsync(folder.value) != 0)
    throw storage_error("cannot sync", file.parent_path());
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw storage_error("cannot read", file);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return std::move(bytes).str();
}

}  // namespace penumbra::server::storage
