#pragma once

#include <string>

namespace penumbra::scenes {

/// Text from a file or a person as UTF-8: bytes that are none become U+FFFD.
std::string valid_text(const std::string& text);

/// The text for a message: valid, and cut after `longest` bytes.
std::string shortened(const std::string& text, std::size_t longest = 300);

/// 'text' for a message: valid, and cut after 100 bytes.
std::string in_quotes(const std::string& text);

}  // namespace penumbra::scenes
