#include "server/jobs/message.h"
#include "scenes/json_text.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr std::size_t max_line = std::size_t{64} << 20;
constexpr int poll_ms = 20;

/// Waits for `events`, at most until `deadline` and the next look at `stop`; returns what ended the
/// wait, or `message` where it is worth trying.
Exchange await(int descriptor, short events, steady_clock::time_point deadline,
               const std::function<bool()>& stop, bool& ready) {
  ready = false;
  if (stop && stop()) return Exchange::stopped;
  const auto left = deadline - steady_clock::now();
  if (left <= steady_clock::duration::zero()) return Exchange::deadline;
  pollfd waiting{descriptor, events, 0};
  const auto left_ms = std::chrono::duration_cast<std::chrono::milliseconds>(left).count() + 1;
  const int found = ::poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left_ms, poll_ms)));
  if (found < 0 && errno != EINTR) return Exchange::closed;
  ready = found > 0;
  return Exchange::message;
}

/// Writes all of `bytes`; a descriptor that would block is waited for.
Exchange write_all(int descriptor, std::string_view bytes, steady_clock::time_point deadline,
                   const std::function<bool()>& stop) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    if (count >= 0 || errno == EINTR) continue;
    if (errno != EAGAIN) return Exchange::closed;
    bool ready = false;
    const Exchange outcome = await(descriptor, POLLOUT, deadline, stop, ready);
    if (outcome != Exchange::message) return outcome;
  }
  return Exchange::message;
}

/// Sizes that a head line announces, or nothing where it makes no sense.
std::optional<std::size_t> announced_bytes(const json& head) {
  std::size_t total = 0;
  const auto blobs = head.find("blobs");
  if (blobs == head.end()) return total;
  if (!blobs->is_array()) return {};
  for (const json& blob : *blobs) {
    if (!blob.is_object() || !blob.contains("name") || !blob["name"].is_string()) return {};
    if (!blob.contains("bytes") || !blob["bytes"].is_number_unsigned()) return {};
    const std::size_t bytes = blob["bytes"];
    if (bytes > max_message_bytes - total) return {};
    total += bytes;
  }
  return total;
}

}  // namespace

Exchange write_message(int descriptor, const Message& message, steady_clock::time_point deadline,
                       const std::function<bool()>& stop) {
  json head = message.body;
  if (!message.blobs.empty()) {
    json list = json::array();
    for (const auto& [name, bytes] : message.blobs)
      list.push_back({{"name", name}, {"bytes", bytes.size()}});
    head["blobs"] = std::move(list);
  }
  const std::string line = scenes::json_text(head) + "\n";
  Exchange outcome = write_all(descriptor, line, deadline, stop);
  for (auto blob = message.blobs.begin();
       blob != message.blobs.end() && outcome == Exchange::message; ++blob)
    outcome = write_all(descriptor, blob->second, deadline, stop);
  return outcome;
}

void write_message(int descriptor, const Message& message) {
  if (write_message(descriptor, message, steady_clock::time_point::max(), {}) != Exchange::message)
    throw std::system_error(errno, std::generic_category(), "writing to a worker");
}

bool MessageReader::take(Message& message) {
  if (!head_) {
    const std::size_t end = buffer_.find('\n');
    if (end == std::string::npos) {
      if (buffer_.size() > max_line) throw std::length_error("endless line");
      return false;
    }
    json head = json::parse(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(end));
    const auto bytes = announced_bytes(head);
    if (!head.is_object() || !bytes) throw std::length_error("head without sense");
    head_ = std::move(head);
    awaited_ = *bytes;
    buffer_.erase(0, end + 1);
  }
  if (buffer_.size() < awaited_) return false;

  message.blobs.clear();
  std::size_t begin = 0;
  for (const json& blob : head_->value("blobs", json::array())) {
    const std::size_t bytes = blob["bytes"];
    message.blobs[blob["name"]] = buffer_.substr(begin, bytes);
    begin += bytes;
  }
  buffer_.erase(0, begin);
  head_->erase("blobs");
  message.body = std::move(*head_);
  head_.reset();
  return true;
}

Exchange MessageReader::read(Message& message, steady_clock::time_point deadline,
                             const std::function<bool()>& stop) {
  std::string piece(std::size_t{1} << 16, '\0');
  try {
    while (!take(message)) {
      bool ready = false;
      const Exchange outcome = await(descriptor_, POLLIN, deadline, stop, ready);
      if (outcome != Exchange::message) return outcome;
      if (!ready) continue;
      const ssize_t count = ::read(descriptor_, piece.data(), piece.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return Exchange::closed;
      buffer_.append(piece.data(), static_cast<std::size_t>(count));
    }
  } catch (const std::exception&) {
    return Exchange::garbled;  // not JSON, no object, sizes without sense: no worker of ours
  }
  return Exchange::message;
}

}  // namespace penumbra::server
