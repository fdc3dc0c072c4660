#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "renderer/vulkan/device.h"

namespace penumbra::vulkan {

/// Adds up what was asked of the device, by name. Several allocations of one name are summed.
struct MemoryLedger {
  std::vector<ResourceCost> entries;

  void add(const std::string& name, std::uint64_t bytes);
};

enum class MemoryKind {
  device,    ///< fastest for the device
  upload,    ///< written by the host, mapped
  readback,  ///< read by the host, mapped and cached
};

/// A range of a buffer, as shaders see it.
struct BufferRange {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;
  VkDeviceSize size = 0;
};

class Buffer {
 public:
  Buffer() = default;
  /// `bytes` of at least 1. Charges `ledger` under `name`. Throws `unsupported` naming the buffer
  /// when memory or a limit is exceeded.
  Buffer(Device& device, MemoryLedger& ledger, const std::string& name, VkDeviceSize bytes,
         VkBufferUsageFlags usage, MemoryKind kind = MemoryKind::device);

  explicit operator bool() const { return size_ != 0; }
  VkBuffer handle() const { return buffer_; }
  VkDeviceSize size() const { return size_; }
  void* mapped() const { return mapped_; }
  BufferRange whole() const { return {buffer_, 0, size_}; }
  BufferRange range(VkDeviceSize offset, VkDeviceSize size) const {
    return {buffer_, offset, size};
  }

 private:
  Owned<VkDeviceMemory> memory_;  // outlives the buffer that is bound to it
  Owned<VkBuffer> buffer_;
  VkDeviceSize size_ = 0;
  void* mapped_ = nullptr;
};

struct ImageDescription {
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::uint32_t layers = 1;
  std::uint32_t levels = 1;
  VkImageUsageFlags usage = 0;
  bool array_view = false;  ///< view as sampler2DArray even with one layer
};

/// A 2D image or array, always in layout GENERAL, with views that shaders and passes need.
class Image {
 public:
  Image() = default;
  /// Checks the device's limits first (a driver may accept what it cannot hold), allocates, charges
  /// `ledger`, and moves the image to layout GENERAL.
  Image(Device& device, MemoryLedger& ledger, const std::string& name,
        const ImageDescription& description);

  explicit operator bool() const { return image_ != VK_NULL_HANDLE; }
  VkImage handle() const { return image_; }
  const ImageDescription& description() const { return description_; }
  VkImageAspectFlags aspects() const { return aspects_; }
  VkImageView view() const { return view_; }  ///< depth or colour, all layers and levels
  VkImageView stencil_view() const { return stencil_view_; }  ///< null without stencil
  /// One layer and level, for attachments and storage images.
  VkImageView slice(std::uint32_t layer, std::uint32_t level = 0) const {
    return slices_[std::size_t{level} * description_.layers + layer];
  }

 private:
  void make_views(Device& device);
  Owned<VkDeviceMemory> memory_;
  Owned<VkImage> image_;
  Owned<VkImageView> view_;
  Owned<VkImageView> stencil_view_;
  std::vector<Owned<VkImageView>> slices_;
  ImageDescription description_;
  VkImageAspectFlags aspects_ = 0;
};

/// Bytes of a texel; drivers may pad depth beside stencil.
std::uint32_t texel_bytes(VkFormat format);
bool has_stencil(VkFormat format);
bool has_depth(VkFormat format);

/// Host memory for constants of one frame: reset when the frame's fence has passed.
class ConstantArena {
 public:
  ConstantArena(Device& device, MemoryLedger& ledger, VkDeviceSize bytes);

  /// Copies `bytes` of `data`; the range stays valid until reset.
  BufferRange push(const void* data, VkDeviceSize bytes);
  template <class T>
  BufferRange push(const T& value) {
    return push(&value, sizeof(T));
  }
  template <class T>
  BufferRange push_array(std::span<const T> values) {
    return push(values.data(), values.size_bytes());
  }
  void reset() { used_ = 0; }
  /// Frees everything pushed since `mark` was taken, once the device has read it.
  VkDeviceSize mark() const { return used_; }
  void rewind(VkDeviceSize mark) { used_ = mark; }

 private:
  Buffer buffer_;
  VkDeviceSize alignment_ = 256;
  VkDeviceSize used_ = 0;
};

}  // namespace penumbra::vulkan
