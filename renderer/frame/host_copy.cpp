#include "renderer/frame/host_copy.h"

#include <cstring>

namespace penumbra {
namespace {

VkBufferImageCopy whole_layer(const vulkan::Image& image, std::uint32_t layer) {
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
  copy.imageExtent = {image.description().width, image.description().height, 1};
  return copy;
}

/// Through cached host memory: reading write-combined device memory is many times slower.
void copy_to_host(vulkan::Device& device, const vulkan::Image& image, std::uint32_t layer,
                  void* target, std::size_t bytes) {
  vulkan::MemoryLedger passing;
  const vulkan::Buffer buffer(device, passing, "read-back", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              vulkan::MemoryKind::readback);
  vulkan::run_now(device, [&](VkCommandBuffer commands) {
    const VkBufferImageCopy copy = whole_layer(image, layer);
    vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_GENERAL, buffer.handle(), 1,
                           &copy);
  });
  std::memcpy(target, buffer.mapped(), bytes);
}

template <class T>
Image<T> read(vulkan::Device& device, const vulkan::Image& image, std::uint32_t channels,
              std::uint32_t layer) {
  Image<T> result(image.description().width, image.description().height, channels);
  copy_to_host(device, image, layer, result.pixels.data(), result.pixels.size() * sizeof(T));
  return result;
}

}  // namespace

Image8 read_rgba8(vulkan::Device& device, const vulkan::Image& image, std::uint32_t layer) {
  return read<std::uint8_t>(device, image, 4, layer);
}

ImageF read_float(vulkan::Device& device, const vulkan::Image& image, std::uint32_t channels,
                  std::uint32_t layer) {
  return read<float>(device, image, channels, layer);
}

void write_float(vulkan::Device& device, const vulkan::Image& image, const ImageF& content) {
  vulkan::MemoryLedger passing;
  const std::size_t bytes = content.pixels.size() * sizeof(float);
  const vulkan::Buffer buffer(device, passing, "upload", bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                              vulkan::MemoryKind::upload);
  std::memcpy(buffer.mapped(), content.pixels.data(), bytes);
  vulkan::run_now(device, [&](VkCommandBuffer commands) {
    const VkBufferImageCopy copy = whole_layer(image, 0);
    vkCmdCopyBufferToImage(commands, buffer.handle(), image.handle(), VK_IMAGE_LAYOUT_GENERAL, 1,
                           &copy);
  });
}

}  // namespace penumbra
