#pragma once

#include <string>
#include <string_view>

namespace penumbra::study {

/// Two lower-case digits a byte.
std::string hexadecimal(std::string_view bytes);

/// SHA-256 as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

}  // namespace penumbra::study
