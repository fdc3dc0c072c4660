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

}  // namespace penumbra
