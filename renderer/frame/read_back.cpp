#include "renderer/frame/read_back.h"

#include <cstring>

namespace penumbra {
namespace {

/// Through cached host memory: reading write-combined device memory is many times slower.
void copy_to_host(vulkan::Device& device, const vulkan::Image& image, std::uint32_t layer,
                  void* target, std::size_t bytes) {
  vulkan::MemoryLedger passing;
  const vulkan::Buffer buffer(device, passing, "read-back", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              vulkan::MemoryKind::readback);
  vulkan::run_now(device, [&](VkCommandBuffer commands) {
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
    copy.imageExtent = {image.description().width, image.description().height, 1};
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

}  // namespace penumbra
