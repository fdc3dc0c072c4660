#include "server/files/durable_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace penumbra::server {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

struct Descriptor {
  int value = -1;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

void write_synced(const std::filesystem::path& path, std::string_view bytes, unsigned mode) {
  const Descriptor file{::open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, mode)};
  if (file.value < 0) fail("cannot create " + path.string());
  while (!bytes.empty()) {
    const ssize_t count = ::write(file.value, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot write " + path.string());
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  if (::fdatasync(file.value) != 0) fail("cannot sync " + path.string());
}

}  // namespace

void write_durably(const std::filesystem::path& path, const std::filesystem::path& temporary,
                   std::string_view bytes, const Durably& how) {
  try {
    write_synced(temporary, bytes, how.mode);
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot rename to " + path.string());
  } catch (const std::system_error&) {
    ::unlink(temporary.c_str());
    throw;
  }
  if (!how.sync_folder) return;
  const auto parent = path.parent_path();
  const Descriptor folder{::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (folder.value < 0 || ::fsync(folder.value) != 0) fail("cannot sync " + parent.string());
}

std::optional<std::string> read_whole(const std::filesystem::path& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)};
  struct stat about {};
  if (file.value < 0 || ::fstat(file.value, &about) != 0 || !S_ISREG(about.st_mode)) return {};
  std::string bytes(static_cast<std::size_t>(about.st_size), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(file.value, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return {};
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

}  // namespace penumbra::server
