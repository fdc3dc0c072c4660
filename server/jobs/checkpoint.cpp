#include "server/jobs/checkpoint.h"

#include <unistd.h>

#include <system_error>

#include "server/files/digest.h"
#include "server/files/durable_file.h"

namespace penumbra::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t digest_length = 64;
constexpr auto kept_for = std::chrono::hours(7 * 24);

}  // namespace

Checkpoint::Checkpoint(CheckpointFolder folder, const std::string& id)
    : folder_(std::move(folder)),
      file_(folder_.path.empty() ? fs::path() : folder_.path / (id + ".state")) {}

std::string Checkpoint::load() const {
  if (file_.empty()) return {};
  const auto bytes = read_whole(file_);
  if (!bytes || bytes->size() < digest_length) return {};
  std::string state = bytes->substr(digest_length);
  return sha256(state) == bytes->substr(0, digest_length) ? state : std::string();
}

void Checkpoint::offer(const std::function<std::string()>& state) {
  using Seconds = std::chrono::duration<double>;
  const auto now = std::chrono::steady_clock::now();
  if (file_.empty() || Seconds(now - last_).count() < folder_.every_s) return;
  try {
    fs::create_directories(folder_.path);
    const std::string bytes = state();
    fs::path temporary = file_;
    temporary += "." + std::to_string(::getpid());
    write_durably(file_, temporary, sha256(bytes) + bytes);
  } catch (const std::system_error&) {
    // The picture is worth more than its checkpoint.
  }
  last_ = std::chrono::steady_clock::now();
}

void Checkpoint::remove() const {
  std::error_code ignored;
  if (!file_.empty()) fs::remove(file_, ignored);
}

void sweep_checkpoints(const fs::path& folder) {
  std::error_code error;
  const auto now = fs::file_time_type::clock::now();
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const auto written = entry.last_write_time(error);
    if (!error && now - written > kept_for) fs::remove(entry.path(), error);
  }
}

}  // namespace penumbra::server
