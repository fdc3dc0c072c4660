#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra {

/// A picture of `channels` interleaved components per pixel, row 0 on top.
template <class T>
struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t channels = 0;
  std::vector<T> pixels;  ///< width * height * channels

  Image() = default;
  Image(std::uint32_t w, std::uint32_t h, std::uint32_t c, T fill = T{})
      : width(w), height(h), channels(c), pixels(std::size_t{w} * h * c, fill) {}

  bool empty() const { return pixels.empty(); }
  std::size_t pixel_count() const { return std::size_t{width} * height; }
  T& at(std::uint32_t x, std::uint32_t y, std::uint32_t c) {
    return pixels[(std::size_t{y} * width + x) * channels + c];
  }
  const T& at(std::uint32_t x, std::uint32_t y, std::uint32_t c) const {
    return pixels[(std::size_t{y} * width + x) * channels + c];
  }
};

using Image8 = Image<std::uint8_t>;  ///< sRGB-encoded where it is a colour
using ImageF = Image<float>;         ///< linear light, visibility, or an error

}  // namespace penumbra
