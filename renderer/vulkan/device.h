#pragma once

#include <vulkan/vulkan.h>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "renderer/device.h"

/// A thin layer over the Vulkan C API: owners, memory that is accounted for, shaders with
/// reflection, recording with timestamps. All images stay in VK_IMAGE_LAYOUT_GENERAL; passes are
/// separated by global barriers, which the timestamps need anyway.
namespace penumbra::vulkan {

/// Throws a device error naming the call unless `result` is VK_SUCCESS.
void check(VkResult result, const char* call);

template <class T>
struct Destroy;  // how each kind of handle is destroyed: device.cpp
#define PENUMBRA_DESTROY(Type)                      \
  template <>                                       \
  struct Destroy<Type> {                            \
    static void call(VkDevice device, Type handle); \
  };
PENUMBRA_DESTROY(VkBuffer)
PENUMBRA_DESTROY(VkImage)
PENUMBRA_DESTROY(VkImageView)
PENUMBRA_DESTROY(VkBufferView)
PENUMBRA_DESTROY(VkDeviceMemory)
PENUMBRA_DESTROY(VkSampler)
PENUMBRA_DESTROY(VkPipeline)
PENUMBRA_DESTROY(VkPipelineLayout)
PENUMBRA_DESTROY(VkDescriptorSetLayout)
PENUMBRA_DESTROY(VkCommandPool)
PENUMBRA_DESTROY(VkFence)
PENUMBRA_DESTROY(VkQueryPool)
#undef PENUMBRA_DESTROY

/// The one move-only owner of device objects.
template <class T>
class Owned {
 public:
  Owned() = default;
  Owned(VkDevice device, T handle) : device_(device), handle_(handle) {}
  Owned(Owned&& other) noexcept { swap(other); }
  Owned& operator=(Owned&& other) noexcept {
    Owned moved(std::move(other));
    swap(moved);
    return *this;
  }
  ~Owned() {
    if (handle_ != VK_NULL_HANDLE) Destroy<T>::call(device_, handle_);
  }
  operator T() const { return handle_; }
  const T* address() const { return &handle_; }

 private:
  void swap(Owned& other) {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
  }
  VkDevice device_ = VK_NULL_HANDLE;
  T handle_ = VK_NULL_HANDLE;
};

/// Collects what the validation layer says.
struct ValidationLog {
  std::mutex mutex;
  std::vector<std::string> messages;
};

/// Instance, physical device, logical device and its one graphics and compute queue.
class Device {
 public:
  /// Chooses by options.device: an index, a part of a name (any case), or empty for a GPU where
  /// there is one, otherwise the first device. Throws bad_value (field "device") listing the
  /// devices, or a device error that names the missing feature.
  explicit Device(const RendererOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceMemoryProperties memory{};
  VkPhysicalDeviceFeatures features{};  ///< those that are switched on
  DeviceInfo info;

  /// Whether fragment stages read a block's members once for each lane, as Mesa 22.3 compiles them
  /// for processors (emit_load_ubo in lp_bld_nir_soa.c). See ProgramSource::constants_from_vertex.
  bool reads_blocks_by_lane() const { return info.type == "cpu"; }
  /// Whether texelFetch finds a level of detail for each lane, as Mesa 22.3 compiles it for
  /// processors (lod_property in lp_bld_sample_soa.c). See renderer/shaders/texel.glsl.
  bool finds_levels_by_lane() const { return info.type == "cpu"; }

  PFN_vkCmdPushDescriptorSetKHR push_descriptors = nullptr;
  PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;  ///< null without the extension
  PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;

  /// What run_now needs, kept for its next call.
  struct OneTimeWork {
    Owned<VkCommandPool> pool;
    Owned<VkFence> fence;
    VkCommandBuffer commands = VK_NULL_HANDLE;
  };
  OneTimeWork one_time;

  /// Index of the first memory type among `type_bits` that has all `wanted` and, if there is one,
  /// all `preferred` properties.
  std::uint32_t memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags wanted,
                            VkMemoryPropertyFlags preferred) const;

  /// What requests are checked against. A device that is the processor has the machine's memory,
  /// whatever its one heap says.
  DeviceLimits limits() const;

  /// Throws a device error with the collected validation messages, if there are any.
  void throw_if_validation_failed();

 private:
  struct Offered {
    VkPhysicalDeviceFeatures core;
    VkPhysicalDeviceVulkan12Features since12;
    VkPhysicalDeviceVulkan13Features since13;
  };
  Offered offered_features() const;
  /// Every feature that is needed, or throws; the optional ones where the device has them.
  void choose_features(const Offered& offered);
  /// The first with graphics, compute and timestamps.
  std::uint32_t find_queue_family() const;
  void create_logical_device();
  void release();
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  ValidationLog log_;
};

}  // namespace penumbra::vulkan
