#include "renderer/frame/window.h"

#include <algorithm>

namespace penumbra {

std::vector<Window> cover(std::uint32_t width, std::uint32_t height, std::uint32_t side,
                          std::uint64_t most_samples, std::uint32_t longest) {
  const std::uint64_t in_pixel = std::uint64_t{side} * side;
  const auto parts = [](std::uint64_t whole, std::uint64_t most) {
    return static_cast<std::uint32_t>((whole + most - 1) / most);
  };
  // Whole rows where a row fits; bands are what every pass likes best.
  const std::uint64_t most_pixels = std::max<std::uint64_t>(1, most_samples / in_pixel);
  const std::uint64_t widest = std::clamp<std::uint64_t>(longest / side, 1, most_pixels);
  const std::uint32_t columns = parts(width, widest);
  const std::uint32_t across = parts(width, columns);
  const std::uint64_t highest = std::min<std::uint64_t>(longest / side, most_pixels / across);
  const std::uint32_t rows = parts(height, std::max<std::uint64_t>(1, highest));
  const std::uint32_t down = parts(height, rows);
  std::vector<Window> windows;
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
      windows.push_back({std::min(column * across, width - across),
                         std::min(row * down, height - down), across, down});
  return windows;
}

CameraMatrices camera_of_window(const CameraMatrices& camera, const Window& window,
                                std::uint32_t width, std::uint32_t height) {
  const glm::dvec2 picture(width, height);
  const glm::dvec2 low = 2.0 * glm::dvec2(window.x, window.y) / picture - 1.0;
  const glm::dvec2 size = 2.0 * glm::dvec2(window.width, window.height) / picture;
  const glm::dvec2 scale = 2.0 / size;
  const glm::dvec2 shift = -scale * (low + 0.5 * size);
  glm::dmat4 clip_from_whole(1.0);
  clip_from_whole[0][0] = scale.x;
  clip_from_whole[1][1] = scale.y;
  clip_from_whole[3] = glm::dvec4(shift, 0.0, 1.0);
  CameraMatrices seen = camera;
  seen.clip_from_world = clip_from_whole * camera.clip_from_world;
  seen.world_from_clip = camera.world_from_clip * glm::inverse(clip_from_whole);
  return seen;
}

}  // namespace penumbra
