#pragma once

#include "renderer/vulkan/memory.h"

namespace penumbra {

/// What the camera sees, a sample per texel. Techniques may read all of it; those that declared
/// `stencil` may test against and write the stencil, which is zero when prepare begins.
struct GeometryBuffer {
  static constexpr VkFormat position_format = VK_FORMAT_R32G32B32A32_SFLOAT;
  static constexpr VkFormat words_format = VK_FORMAT_R32G32B32A32_UINT;
  static constexpr VkFormat emitted_format = VK_FORMAT_R32G32B32A32_SFLOAT;

  vulkan::Image position;  ///< xyz world, w 0 on background, otherwise see geometry_buffer.glsl
  vulkan::Image words;     ///< packed surface, see geometry_buffer.glsl
  vulkan::Image depth;     ///< reversed: 1 near, 0 infinity
  vulkan::Image emitted;   ///< linear light, or none where nothing visible emits any
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

}  // namespace penumbra
