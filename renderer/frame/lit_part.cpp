#include "renderer/frame/lit_part.h"

#include <algorithm>
#include <cmath>

#include "renderer/scene/convex_clip.h"

namespace penumbra {

VkRect2D seen_part(std::span<const Bounds> boxes, const glm::dvec3& origin,
                   const glm::dmat4& clip_from_world, std::uint32_t width, std::uint32_t height) {
  // Samples: vertices are rounded on their way to the rasteriser.
  constexpr double margin = 1.0;
  const glm::dvec2 size(width, height);
  const HalfSpace front = near_plane(clip_from_world);
  glm::dvec2 low = size;
  glm::dvec2 high(0.0);
  bool known = true;
  for (const Bounds& box : boxes)
    visit_clipped_corners({box.low - origin, box.high - origin}, {&front, 1},
                          [&](const glm::dvec3& corner) {
                            const glm::dvec4 clip = clip_from_world * glm::dvec4(corner, 1.0);
                            const glm::dvec2 place = (0.5 + 0.5 * glm::dvec2(clip) / clip.w) * size;
                            known = known && std::isfinite(place.x) && std::isfinite(place.y);
                            low = glm::min(low, place);
                            high = glm::max(high, place);
                          });
  if (!known) return {{0, 0}, {width, height}};
  low = glm::clamp(glm::floor(low - margin), glm::dvec2(0.0), size);
  high = glm::clamp(glm::ceil(high + margin), low, size);
  const glm::dvec2 extent = high - low;
  return {{static_cast<std::int32_t>(low.x), static_cast<std::int32_t>(low.y)},
          {static_cast<std::uint32_t>(extent.x), static_cast<std::uint32_t>(extent.y)}};
}

std::vector<VkRect2D> outside(const VkRect2D& part, std::uint32_t width, std::uint32_t height) {
  const auto left = static_cast<std::uint32_t>(part.offset.x);
  const auto top = static_cast<std::uint32_t>(part.offset.y);
  const std::uint32_t right = left + part.extent.width;
  const std::uint32_t bottom = top + part.extent.height;
  std::vector<VkRect2D> rest;
  const auto add = [&](std::uint32_t x, std::uint32_t y, std::uint32_t w, std::uint32_t h) {
    if (w > 0 && h > 0)
      rest.push_back({{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)}, {w, h}});
  };
  add(0, 0, width, top);
  add(0, top, left, bottom - top);
  add(right, top, width - right, bottom - top);
  add(0, bottom, width, height - bottom);
  return rest;
}

}  // namespace penumbra
