#include "renderer/vulkan/texel_view.h"

#include "renderer/error.h"

namespace penumbra::vulkan {

Owned<VkBufferView> texel_view(Device& device, const std::string& name, const Buffer& buffer,
                               VkFormat format, std::size_t texel_bytes) {
  const std::size_t limit = device.properties.limits.maxTexelBufferElements;
  const std::size_t texels = buffer.size() / texel_bytes;
  if (texels > limit)
    throw unsupported("the scene or the picture is too large for this device: " + name + " take " +
                      std::to_string(texels) + " of at most " + std::to_string(limit) + " texels");
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = buffer.handle();
  info.format = format;
  info.range = VK_WHOLE_SIZE;
  VkBufferView view = VK_NULL_HANDLE;
  check(vkCreateBufferView(device.handle, &info, nullptr, &view), "vkCreateBufferView");
  return {device.handle, view};
}

TexelBuffer make_texel_buffer(Device& device, MemoryLedger& ledger, const std::string& name,
                              VkDeviceSize bytes, VkBufferUsageFlags usage, VkFormat format,
                              std::size_t texel_bytes) {
  TexelBuffer made;
  made.buffer =
      Buffer(device, ledger, name, bytes, usage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  made.view = texel_view(device, name, made.buffer, format, texel_bytes);
  return made;
}

}  // namespace penumbra::vulkan
