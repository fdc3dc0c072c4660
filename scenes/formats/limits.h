#pragma once

#include <cstdint>
#include <string>

#include "renderer/error.h"
#include "renderer/image.h"

namespace penumbra::scenes {

/// Throws unreadable for pictures without pixels or larger than 16384 along a side or 2^27 in all,
/// for more than 4 channels, and where RGBA of it takes more than `most_bytes`.
inline void check_decodable(std::uint64_t width, std::uint64_t height, std::uint64_t channels,
                            std::uint64_t most_bytes) {
  constexpr std::uint64_t most_side = 16384;
  constexpr std::uint64_t most_pixels = std::uint64_t{1} << 27;
  const std::string size = std::to_string(width) + " by " + std::to_string(height) + " pixels";
  if (width < 1 || height < 1 || channels < 1) throw unreadable("the picture has no pixels");
  if (width > most_side || height > most_side || width * height > most_pixels)
    throw unreadable("the picture is too large: " + size);
  if (channels > 4)
    throw unreadable("the picture has " + std::to_string(channels) +
                     " channels, more than red, green, blue and alpha");
  if (4 * width * height > most_bytes)
    throw unreadable("the picture of " + size + " takes more than the " +
                     std::to_string(most_bytes >> 20) + " MiB that are left for pictures");
}

template <class T>
void check_encodable(const Image<T>& picture) {
  if (picture.width == 0 || picture.height == 0 || picture.channels == 0 ||
      picture.pixels.size() != picture.pixel_count() * picture.channels)
    throw bad_value("picture", "a picture without pixels cannot be written");
}

}  // namespace penumbra::scenes
