#pragma once

#include <cstdint>
#include <vector>

#include "renderer/scene/transforms.h"

namespace penumbra {

/// A rectangle of the picture that is drawn at once, pixels; row 0 on top.
struct Window {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Windows of one size that cover a picture, row by row; the last of a row or column may overlap
/// the one before it. None has more than `most_samples` samples, `side` * `side` in a pixel, nor
/// more than `longest` of them along an edge.
std::vector<Window> cover(std::uint32_t width, std::uint32_t height, std::uint32_t side,
                          std::uint64_t most_samples, std::uint32_t longest);

/// The camera that sees of a picture of `width` x `height` what the window shows.
CameraMatrices camera_of_window(const CameraMatrices& camera, const Window& window,
                                std::uint32_t width, std::uint32_t height);

}  // namespace penumbra
