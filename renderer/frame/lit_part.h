#pragma once

#include <span>
#include <vector>

#include "renderer/scene/scene.h"
#include "renderer/vulkan/device.h"

namespace penumbra {

/// The samples of a frame that boxes may be seen in: no light that reaches only these adds anything
/// elsewhere. Boxes are in the scene's coordinates, the matrix maps what lies `origin` from there.
VkRect2D seen_part(std::span<const Bounds> boxes, const glm::dvec3& origin,
                   const glm::dmat4& clip_from_world, std::uint32_t width, std::uint32_t height);

/// What of a frame lies outside a part of it: up to four rectangles.
std::vector<VkRect2D> outside(const VkRect2D& part, std::uint32_t width, std::uint32_t height);

}  // namespace penumbra
