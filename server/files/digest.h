#pragma once

#include <string>
#include <string_view>

namespace penumbra::server {

/// Two lower-case digits a byte.
std::string hexadecimal(std::string_view bytes);

/// SHA-256 as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// HMAC-SHA256 as 64 hexadecimal digits (RFC 2104).
std::string keyed_digest(std::string_view key, std::string_view text);

/// Bytes of the operating system's random source.
std::string random_bytes(std::size_t count);

}  // namespace penumbra::server
