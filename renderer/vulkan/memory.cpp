#include "renderer/vulkan/memory.h"

#include <algorithm>

#include "renderer/error.h"
#include "renderer/vulkan/commands.h"

namespace penumbra::vulkan {
namespace {

/// `before` is what its owner was given already: all of it is held at the same time.
Owned<VkDeviceMemory> allocate(Device& device, const VkMemoryRequirements& needs, MemoryKind kind,
                               const std::string& name, const MemoryLedger& before) {
  VkMemoryPropertyFlags wanted = 0;
  VkMemoryPropertyFlags preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  if (kind != MemoryKind::device) {
    wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    preferred = kind == MemoryKind::readback ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT : 0;
  }
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = needs.size;
  info.memoryTypeIndex = device.memory_type(needs.memoryTypeBits, wanted, preferred);
  VkDeviceSize total = needs.size;
  for (const ResourceCost& entry : before.entries) total += entry.bytes;
  // Checked here, since a driver may promise more than its heap holds.
  const std::uint32_t heap = device.memory.memoryTypes[info.memoryTypeIndex].heapIndex;
  const bool fits = total <= device.memory.memoryHeaps[heap].size;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  if (!fits || vkAllocateMemory(device.handle, &info, nullptr, &memory) != VK_SUCCESS)
    throw unsupported("not enough memory for " + name + ": " + std::to_string(needs.size) +
                      " bytes, " + std::to_string(total) + " in all");
  return {device.handle, memory};
}

VkImageAspectFlags aspects_of(VkFormat format) {
  VkImageAspectFlags aspects = 0;
  if (has_depth(format)) aspects |= VK_IMAGE_ASPECT_DEPTH_BIT;
  if (has_stencil(format)) aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
  return aspects != 0 ? aspects : VkImageAspectFlags{VK_IMAGE_ASPECT_COLOR_BIT};
}

Owned<VkImageView> make_view(Device& device, VkImage image, VkFormat format, VkImageViewType type,
                             VkImageSubresourceRange range) {
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image;
  info.viewType = type;
  info.format = format;
  info.subresourceRange = range;
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(device.handle, &info, nullptr, &view), "vkCreateImageView");
  return {device.handle, view};
}

}  // namespace

void MemoryLedger::add(const std::string& name, std::uint64_t bytes) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const auto& entry) { return entry.name == name; });
  if (found != entries.end())
    found->bytes += bytes;
  else
    entries.push_back({name, bytes});
}

std::uint32_t texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT:
      return 16;
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return 8;
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_D16_UNORM:
      return 2;
    case VK_FORMAT_R8_UNORM:
      return 1;
    default:
      return 4;
  }
}

bool has_stencil(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT;
}

bool has_depth(VkFormat format) {
  return has_stencil(format) || format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D16_UNORM;
}

Buffer::Buffer(Device& device, MemoryLedger& ledger, const std::string& name, VkDeviceSize bytes,
               VkBufferUsageFlags usage, MemoryKind kind)
    : size_(bytes) {
  const auto& limits = device.properties.limits;
  if ((usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) != 0 && bytes > limits.maxStorageBufferRange)
    throw unsupported(name + " of " + std::to_string(bytes) +
                      " bytes exceeds the device's limit of " +
                      std::to_string(limits.maxStorageBufferRange) + " for a storage buffer");
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = usage;
  VkBuffer buffer = VK_NULL_HANDLE;
  check(vkCreateBuffer(device.handle, &info, nullptr, &buffer), "vkCreateBuffer");
  buffer_ = {device.handle, buffer};
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.handle, buffer, &needs);
  memory_ = allocate(device, needs, kind, name, ledger);
  check(vkBindBufferMemory(device.handle, buffer, memory_, 0), "vkBindBufferMemory");
  if (kind != MemoryKind::device)
    check(vkMapMemory(device.handle, memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
  ledger.add(name, bytes);
}

namespace {

VkImageCreateInfo image_info(const ImageDescription& description) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = description.format;
  info.extent = {description.width, description.height, 1};
  info.mipLevels = description.levels;
  info.arrayLayers = description.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = description.usage;
  info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  return info;
}

/// Throws unless the device can hold the image.
void check_limits(const Device& device, const std::string& name,
                  const ImageDescription& description) {
  const auto& limits = device.properties.limits;
  if (std::max(description.width, description.height) > limits.maxImageDimension2D)
    throw unsupported(name + " of " + std::to_string(description.width) + "x" +
                      std::to_string(description.height) + " exceeds the device's limit of " +
                      std::to_string(limits.maxImageDimension2D));
  if (description.layers > limits.maxImageArrayLayers)
    throw unsupported(name + " has more layers than the device's limit of " +
                      std::to_string(limits.maxImageArrayLayers));
  const VkImageCreateInfo info = image_info(description);
  VkImageFormatProperties format_limits{};
  if (vkGetPhysicalDeviceImageFormatProperties(device.physical, info.format, info.imageType,
                                               info.tiling, info.usage, 0,
                                               &format_limits) != VK_SUCCESS)
    throw device_error("the device has no image format for " + name);
  // Reckoned here, since the driver's own number overflows for huge images.
  const double bytes = 1.0 * texel_bytes(description.format) * description.width *
                       description.height * description.layers *
                       (description.levels > 1 ? 4.0 / 3.0 : 1.0);
  if (bytes > static_cast<double>(format_limits.maxResourceSize))
    throw unsupported(name + " of " + std::to_string(static_cast<std::uint64_t>(bytes)) +
                      " bytes exceeds the device's limit of " +
                      std::to_string(format_limits.maxResourceSize) + " for an image");
}

/// All images stay in the general layout, from when they are made.
void set_general_layout(Device& device, VkImage image, const VkImageSubresourceRange& all) {
  run_now(device, [&](VkCommandBuffer commands) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = all;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
  });
}

}  // namespace

Image::Image(Device& device, MemoryLedger& ledger, const std::string& name,
             const ImageDescription& description)
    : description_(description), aspects_(aspects_of(description.format)) {
  check_limits(device, name, description);
  const VkImageCreateInfo info = image_info(description);
  VkImage image = VK_NULL_HANDLE;
  check(vkCreateImage(device.handle, &info, nullptr, &image), "vkCreateImage");
  image_ = {device.handle, image};
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.handle, image, &needs);
  memory_ = allocate(device, needs, MemoryKind::device, name, ledger);
  check(vkBindImageMemory(device.handle, image, memory_, 0), "vkBindImageMemory");
  ledger.add(name, needs.size);
  make_views(device);
  set_general_layout(device, image_, {aspects_, 0, description.levels, 0, description.layers});
}

void Image::make_views(Device& device) {
  constexpr VkImageUsageFlags viewed = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if ((description_.usage & viewed) == 0) return;
  const VkFormat format = description_.format;
  const VkImageViewType type = description_.layers > 1 || description_.array_view
                                   ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                   : VK_IMAGE_VIEW_TYPE_2D;
  const VkImageAspectFlags aspect =
      has_depth(format) ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT} : aspects_;
  const auto view = [&](VkImageAspectFlags seen, std::uint32_t levels) {
    return make_view(device, image_, format, type, {seen, 0, levels, 0, description_.layers});
  };
  view_ = view(aspect, description_.levels);
  if (has_stencil(format)) stencil_view_ = view(VK_IMAGE_ASPECT_STENCIL_BIT, 1);
  for (std::uint32_t level = 0; level < description_.levels; ++level)
    for (std::uint32_t layer = 0; layer < description_.layers; ++layer)
      slices_.push_back(
          make_view(device, image_, format, VK_IMAGE_VIEW_TYPE_2D, {aspects_, level, 1, layer, 1}));
}

ConstantArena::ConstantArena(Device& device, MemoryLedger& ledger, VkDeviceSize bytes)
    : buffer_(device, ledger, "constants", bytes,
              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
              MemoryKind::upload),
      alignment_(
          std::max({VkDeviceSize{64}, device.properties.limits.minUniformBufferOffsetAlignment,
                    device.properties.limits.minStorageBufferOffsetAlignment})) {}

BufferRange ConstantArena::push(const void* data, VkDeviceSize bytes) {
  const VkDeviceSize offset = (used_ + alignment_ - 1) / alignment_ * alignment_;
  if (offset + bytes > buffer_.size()) throw device_error("a frame uses too many constants");
  std::memcpy(static_cast<char*>(buffer_.mapped()) + offset, data, bytes);
  used_ = offset + bytes;
  return buffer_.range(offset, bytes);
}

}  // namespace penumbra::vulkan
