#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "renderer/error.h"

namespace penumbra::server::http {

// Bounds of a head: bytes in all, bytes of one line without its end, header fields. A line with its
// end is what the library takes at most (8192).
inline constexpr std::size_t longest_head = 32 << 10;
inline constexpr std::size_t longest_line = 8190;
inline constexpr std::size_t most_fields = 100;

/// What the connection needs to know of a request before anything else is read from it.
struct RequestHead {
  std::string method;
  std::size_t size = 0;  ///< bytes of the head with the empty line that ends it
  bool keeps_alive = false;
  bool expects_continue = false;
  bool chunked = false;
  std::uint64_t content_length = 0;  ///< zero where `chunked`

  bool has_body() const { return chunked || content_length > 0; }
};

/// Reads the head of a request (RFC 9112) from the first bytes of a connection. Returns true with
/// `head` filled in once it is there as a whole, false where more bytes are needed. Throws what the
/// request must be refused with: too_many_headers and too_long beyond the bounds, not_allowed for a
/// method that is not among `methods`, bad_value for everything that two readers could understand
/// differently: a bare line feed or control character, a space before a colon, folded lines, two
/// lengths, a length that is no number, an unknown transfer encoding, a target that is no path, and
/// a body where the method has none. What was read so far is judged before the rest is there.
/// The same bytes get the same verdict.
bool read_head(std::string_view bytes, std::span<const std::string> methods, RequestHead& head);

/// True for methods whose requests may have a body here.
bool may_have_body(std::string_view method);

}  // namespace penumbra::server::http
