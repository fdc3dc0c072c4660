#pragma once

#include <string>
#include <string_view>

namespace penumbra::scenes {

std::string base64_encode(std::string_view bytes);
/// Throws unreadable (field `path`) for anything that is no base64.
std::string base64_decode(std::string_view text, const std::string& path);

}  // namespace penumbra::scenes
