#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "server/http/request_head.h"

namespace penumbra::server::http {

/// Follows the bytes of a body to its end, so that what comes after is known to be no part of it.
/// Chunks are read as in RFC 9112, 7.1, without trailers, which nothing here takes.
class BodyFraming {
 public:
  BodyFraming() = default;
  explicit BodyFraming(const RequestHead& head);

  /// How many of these bytes, the next of the connection, belong to the body.
  std::size_t take(std::string_view bytes);

  bool done() const { return state == State::done; }
  /// True where the chunks are none: the connection can be read no further.
  bool broken() const { return state == State::broken; }

 private:
  enum class State { counted, chunk_line, chunk, chunk_end, last_end, done, broken };

  /// Takes one byte of a line between chunks.
  void take_line_byte(char byte);
  void end_chunk_line();

  State state = State::done;
  std::uint64_t left = 0;  ///< bytes of the body or of the chunk
  std::string line;        ///< between chunks
};

}  // namespace penumbra::server::http
