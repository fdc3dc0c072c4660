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
#include <system_error>

#include "renderer/error.h"
#include "server/files/durable_file.h"
#include "server/storage/folder_files.h"

namespace penumbra::server::storage {
namespace {

Error storage_error(const std::string& doing, const std::filesystem::path& file) {
  return {"storage", doing + " " + file.string() + ": " + std::strerror(errno)};
}

constexpr const char* unfinished = ".part";  // in the names of files being written

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
  try {
    write_durably(file, temporary, bytes, {.mode = mode, .sync_folder = true});
  } catch (const std::system_error& error) {
    throw Error("storage", error.what());
  }
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw storage_error("cannot read", file);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return std::move(bytes).str();
}

}  // namespace penumbra::server::storage
