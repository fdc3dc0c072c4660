#include "experiments/engine/results.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "renderer/error.h"
#include "scenes/json_text.h"

namespace penumbra::experiments {
namespace {

Error unwritable(const std::filesystem::path& path) {
  return {"unwritable", "cannot write " + path.string() + ": " + std::strerror(errno), "out"};
}

}  // namespace

Results::Results(const std::filesystem::path& file) : path_(file) {
  file_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_ < 0) throw unwritable(file);
  try {
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0)
      throw Error("busy", "another experiment is writing " + file.string(), "out");
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
  std::ifstream in(path_, std::ios::binary);
  off_t whole = 0;
  for (std::string line; std::getline(in, line) && !in.eof();) {
    const auto row = nlohmann::json::parse(line, nullptr, false);
    if (row.is_object() && row.contains("key") && row.contains("result") &&
        row.at("key").is_string()) {
      rows_[row.at("key").get<std::string>()] = row.at("result");
    } else {
      break;
    }
    whole += static_cast<off_t>(line.size()) + 1;
  }
  if (::ftruncate(file_, whole) != 0) throw unwritable(path_);
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
