#pragma once

#include <string>
#include <string_view>

namespace penumbra::study {

/// SHA-256, 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

}  // namespace penumbra::study
