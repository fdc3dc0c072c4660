#include "experiments/engine/results.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "renderer/error.h"
#include "scenes/json_text.h"

namespace penumbra::experiments {
namespace {

Error unwritable(const std::filesystem::path& path) {
  return {"unwritable", "cannot write " + path.string() + ": " + std::strerror(errno), "out"};
}

/// Whether the file is this process's from now on. A lock of the process, not of the descriptor
/// (flock): children that were forked and outlive a killed parent for a moment do not hold it. It
/// ends with the first descriptor of the file that this process closes.
bool lock(int file) {
  struct flock whole = {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  return ::fcntl(file, F_SETLK, &whole) == 0;
}

std::string content_of(int file, const std::filesystem::path& path) {
  struct stat state = {};
  if (::fstat(file, &state) != 0) throw unwritable(path);
  std::string text(static_cast<std::size_t>(state.st_size), '\0');
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count =
        ::pread(file, text.data() + done, text.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw unwritable(path);
    if (count == 0) text.resize(done);
    done += static_cast<std::size_t>(count);
  }
  return text;
}

}  // namespace

Results::Results(const std::filesystem::path& file) : path_(file) {
  file_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_ < 0) throw unwritable(file);
  try {
    if (!lock(file_)) throw Error("busy", "another experiment is writing " + file.string(), "out");
    read();
  } catch (...) {
    ::close(file_);
    throw;
  }
}

Results::~Results() {
  ::close(file_);
}

void Results::read() {
  const std::string text = content_of(file_, path_);
  std::size_t whole = 0;
  for (std::size_t end = 0; (end = text.find('\n', whole)) != std::string::npos; whole = end + 1) {
    const auto row =
        nlohmann::json::parse(std::string_view(text).substr(whole, end - whole), nullptr, false);
    if (!row.is_object() || !row.contains("key") || !row.contains("result") ||
        !row.at("key").is_string())
      break;
    rows_[row.at("key").get<std::string>()] = row.at("result");
  }
  if (::ftruncate(file_, static_cast<off_t>(whole)) != 0) throw unwritable(path_);
}

const nlohmann::json* Results::find(const std::string& key) const {
  const auto row = rows_.find(key);
  return row == rows_.end() ? nullptr : &row->second;
}

void Results::add(const std::string& key, const nlohmann::json& result) {
  if (rows_.contains(key)) return;
  const std::string line = scenes::json_text({{"key", key}, {"result", result}}) + "\n";
  // One call for the whole line: a kill leaves it or nothing, a full disk a part that read() drops.
  if (::write(file_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    throw unwritable(path_);
  rows_[key] = result;
}

}  // namespace penumbra::experiments
