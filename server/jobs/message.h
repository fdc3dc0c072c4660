#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace penumbra::server {

using Blobs = std::map<std::string, std::string>;  ///< bytes by name

/// What passes between a server and its worker: one line of JSON, then the bytes that the line's
/// key `blobs` announces: [{"name","bytes"}, ..].
struct Message {
  nlohmann::json body = nlohmann::json::object();
  Blobs blobs;
};

/// Largest message that is read; the largest picture with four float channels passes.
inline constexpr std::size_t max_message_bytes = std::size_t{5} << 30;

/// How an exchange ended: the whole message passed, or why it did not.
enum class Exchange { message, closed, deadline, stopped, garbled };

/// Writes all of it to a descriptor that blocks. Throws std::system_error where the other end is
/// gone.
void write_message(int descriptor, const Message& message);

/// Writes to a descriptor that does not block, until `deadline`; asks `stop` every few
/// milliseconds. What was written of a message that did not pass whole is of no use to the reader.
Exchange write_message(int descriptor, const Message& message,
                       std::chrono::steady_clock::time_point deadline,
                       const std::function<bool()>& stop);

/// Reads messages from a pipe.
class MessageReader {
 public:
  explicit MessageReader(int descriptor) : descriptor_(descriptor) {}

  /// Waits for a whole message until `deadline`; asks `stop` every few milliseconds.
  Exchange read(Message& message, std::chrono::steady_clock::time_point deadline,
                const std::function<bool()>& stop = {});

 private:
  bool take(Message& message);  ///< true when the buffer held a whole message
  int descriptor_;
  std::string buffer_;
  std::optional<nlohmann::json> head_;  ///< of the message whose bytes are still under way
  std::size_t awaited_ = 0;             ///< bytes of its blobs
};

}  // namespace penumbra::server
