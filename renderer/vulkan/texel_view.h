#pragma once

#include "renderer/vulkan/memory.h"

namespace penumbra::vulkan {

/// View of a whole buffer of usage UNIFORM_TEXEL_BUFFER, for samplerBuffer and its kin. Throws
/// unsupported naming `name` where the device reads fewer texels.
Owned<VkBufferView> texel_view(Device& device, const std::string& name, const Buffer& buffer,
                               VkFormat format, std::size_t texel_bytes);

}  // namespace penumbra::vulkan
