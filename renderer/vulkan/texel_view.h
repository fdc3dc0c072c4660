#pragma once

#include "renderer/vulkan/memory.h"

namespace penumbra::vulkan {

/// View of a whole buffer of usage UNIFORM_TEXEL_BUFFER, for samplerBuffer and its kin. Throws
/// unsupported naming `name` where the device reads fewer texels.
Owned<VkBufferView> texel_view(Device& device, const std::string& name, const Buffer& buffer,
                               VkFormat format, std::size_t texel_bytes);

/// A buffer that shaders read as texels.
struct TexelBuffer {
  Buffer buffer;
  Owned<VkBufferView> view;
  explicit operator bool() const { return static_cast<bool>(buffer); }
};

/// One of `bytes`, with `usage` beside.
TexelBuffer make_texel_buffer(Device& device, MemoryLedger& ledger, const std::string& name,
                              VkDeviceSize bytes, VkBufferUsageFlags usage, VkFormat format,
                              std::size_t texel_bytes);

}  // namespace penumbra::vulkan
