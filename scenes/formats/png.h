#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "renderer/image.h"

/// PNG through libpng; encode_png of scenes/picture_io.h too (W3C PNG, third edition).
namespace penumbra::scenes {

/// Grey, grey with alpha, RGB or RGBA as the file has it; palettes and fewer bits become RGB and 8
/// bits. Empty for files with 16 bits, which are left to others. Throws unreadable, see
/// check_decodable.
std::optional<Image8> decode_png(std::string_view bytes, std::uint64_t most_bytes);

}  // namespace penumbra::scenes
