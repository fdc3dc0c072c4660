#include "server/jobs/device_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

namespace penumbra::server {
namespace {
constexpr auto between_tries = std::chrono::milliseconds(20);
}

std::filesystem::path DeviceLock::path() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime && *runtime) return std::filesystem::path(runtime) / "penumbra-device.lock";
  return std::filesystem::temp_directory_path() /
         ("penumbra-device-" + std::to_string(::getuid()) + ".lock");
}

DeviceLock::DeviceLock(Mode mode, double patience_s) {
  // No following of links: the folder may be open to other users.
  file_ = ::open(path().c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file_ < 0) return;
  const int operation = (mode == Mode::measure ? LOCK_EX : LOCK_SH) | LOCK_NB;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (true) {
    held_ = ::flock(file_, operation) == 0;
    if (held_ || std::chrono::steady_clock::now() >= end) return;
    std::this_thread::sleep_for(between_tries);
  }
}

DeviceLock::~DeviceLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace penumbra::server
