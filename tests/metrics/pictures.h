#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "renderer/image.h"

/// Pictures that expected_values.py makes too, in integers, so that both see the same bytes.
namespace penumbra::metrics {

using Rgb = std::array<std::uint8_t, 3>;

inline Image8 constant(std::uint32_t width, std::uint32_t height, Rgb color) {
  Image8 picture(width, height, 3);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = color[i % 3];
  return picture;
}

inline Image8 noise(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
  Image8 picture(width, height, 3);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t hash =
            (x * 73856093u) ^ (y * 19349663u) ^ (c * 83492791u) ^ (seed * 2971215073u);
        picture.at(x, y, c) = static_cast<std::uint8_t>((hash * 2654435761u) >> 24);
      }
  return picture;
}

/// A disc in shadow: darkest within `inner` pixels of the middle, lit beyond `outer`.
inline Image8 shadow(std::uint32_t width, std::uint32_t height, int inner, int outer) {
  constexpr std::array base{230, 190, 130};
  const int low = 4 * inner * inner;
  const int high = 4 * outer * outer;
  Image8 picture(width, height, 3);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const int dx = 2 * static_cast<int>(x) - static_cast<int>(width);
      const int dy = 2 * static_cast<int>(y) - static_cast<int>(height);
      const int beyond = std::max(dx * dx + dy * dy - low, 0);
      const int lit = std::min(beyond * 64 / std::max(high - low, 1), 64);
      for (std::uint32_t c = 0; c < 3; ++c)
        picture.at(x, y, c) = static_cast<std::uint8_t>(base[c] * (16 + 48 * lit / 64) / 64);
    }
  return picture;
}

/// Less contrast: 7/8 of every value, and 16.
inline Image8 faint(Image8 picture) {
  for (std::uint8_t& value : picture.pixels) value = static_cast<std::uint8_t>(value * 7 / 8 + 16);
  return picture;
}

/// Inverted in a corner, in a patch further in and in the last pixel; as it was elsewhere.
inline Image8 patched(Image8 picture) {
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x)
      if ((x < 5 && y < 4) || (x >= 93 && x < 100 && y >= 70 && y < 75) ||
          (x + 1 == picture.width && y + 1 == picture.height))
        for (std::uint32_t c = 0; c < 3; ++c) {
          std::uint8_t& value = picture.at(x, y, c);
          value = static_cast<std::uint8_t>(255 - value);
        }
  return picture;
}

}  // namespace penumbra::metrics
