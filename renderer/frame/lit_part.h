#pragma once

#include <span>

#include "renderer/scene/scene.h"
#include "renderer/vulkan/device.h"

namespace penumbra {

/// The samples of a frame that boxes may be seen in: no light that reaches only these adds anything
/// elsewhere. Boxes are in the scene's coordinates, the matrix maps what lies `origin` from there.
VkRect2D seen_part(std::span<const Bounds> boxes, const glm::dvec3& origin,
                   const glm::dmat4& clip_from_world, std::uint32_t width, std::uint32_t height);

}  // namespace penumbra
