#pragma once

#include <string>
#include <string_view>

#include "study/digest.h"

namespace penumbra::server {

using study::hexadecimal;
using study::sha256;

/// HMAC-SHA256 as 64 hexadecimal digits (RFC 2104).
std::string keyed_digest(std::string_view key, std::string_view text);

/// Bytes of the operating system's random source.
std::string random_bytes(std::size_t count);

}  // namespace penumbra::server
