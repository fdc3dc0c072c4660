#include "renderer/vulkan/device.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "renderer/error.h"

namespace penumbra::vulkan {

#define PENUMBRA_DESTROY(Type, Function)                   \
  void Destroy<Type>::call(VkDevice device, Type handle) { \
    Function(device, handle, nullptr);                     \
  }
PENUMBRA_DESTROY(VkBuffer, vkDestroyBuffer)
PENUMBRA_DESTROY(VkImage, vkDestroyImage)
PENUMBRA_DESTROY(VkImageView, vkDestroyImageView)
PENUMBRA_DESTROY(VkBufferView, vkDestroyBufferView)
PENUMBRA_DESTROY(VkDeviceMemory, vkFreeMemory)
PENUMBRA_DESTROY(VkSampler, vkDestroySampler)
PENUMBRA_DESTROY(VkPipeline, vkDestroyPipeline)
PENUMBRA_DESTROY(VkPipelineLayout, vkDestroyPipelineLayout)
PENUMBRA_DESTROY(VkDescriptorSetLayout, vkDestroyDescriptorSetLayout)
PENUMBRA_DESTROY(VkCommandPool, vkDestroyCommandPool)
PENUMBRA_DESTROY(VkFence, vkDestroyFence)
PENUMBRA_DESTROY(VkQueryPool, vkDestroyQueryPool)
#undef PENUMBRA_DESTROY

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

const char* name_of(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "initialization failed";
    case VK_ERROR_DEVICE_LOST:
      return "device lost";
    case VK_ERROR_LAYER_NOT_PRESENT:
      return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      return "extension not present";
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return "feature not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "no Vulkan driver found";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
      return "format not supported";
    default:
      return "failed";
  }
}

VKAPI_ATTR VkBool32 VKAPI_CALL collect_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                               VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data,
                                               void* user) {
  auto* log = static_cast<ValidationLog*>(user);
  const std::lock_guard lock(log->mutex);
  log->messages.emplace_back(data->pMessage);
  return VK_FALSE;
}

bool layer_present(const char* name) {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(),
                     [&](const auto& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

bool instance_extension_present(const char* name, const char* layer) {
  std::uint32_t count = 0;
  vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(), [&](const auto& extension) {
    return std::strcmp(extension.extensionName, name) == 0;
  });
}

VkInstance create_instance(bool validation, bool debug_utils) {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "penumbra";
  application.apiVersion = VK_API_VERSION_1_3;
  std::vector<const char*> layers;
  std::vector<const char*> extensions;
  if (validation) {
    if (!layer_present(validation_layer))
      throw device_error("the Vulkan validation layer is not installed (vulkan-validationlayers)");
    layers.push_back(validation_layer);
  }
  if (debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  create.pApplicationInfo = &application;
  create.enabledLayerCount = static_cast<std::uint32_t>(layers.size());
  create.ppEnabledLayerNames = layers.data();
  create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  create.ppEnabledExtensionNames = extensions.data();
  VkInstance instance = VK_NULL_HANDLE;
  check(vkCreateInstance(&create, nullptr, &instance), "vkCreateInstance");
  return instance;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
  std::uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
  return devices;
}

DeviceInfo describe(VkPhysicalDevice physical, std::uint32_t index) {
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  DeviceInfo info;
  info.index = index;
  info.name = properties.properties.deviceName;
  info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  switch (properties.properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      info.type = "cpu";
      break;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      info.type = "integrated";
      break;
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      info.type = "discrete";
      break;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      info.type = "virtual";
      break;
    default:
      info.type = "other";
  }
  return info;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::size_t choose(const std::vector<DeviceInfo>& infos, const std::string& wanted) {
  if (infos.empty()) throw device_error("no Vulkan device found; install mesa-vulkan-drivers");
  if (wanted.empty()) {
    for (const char* type : {"discrete", "integrated", "virtual"})
      for (std::size_t i = 0; i < infos.size(); ++i)
        if (infos[i].type == type) return i;
    return 0;
  }
  const bool is_index =
      std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c); });
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (is_index && wanted == std::to_string(i)) return i;
    const std::string described = lower(infos[i].name + " " + infos[i].driver);
    // People say lavapipe, the driver reports llvmpipe.
    const std::string known = infos[i].type == "cpu" ? described + " lavapipe" : described;
    if (!is_index && known.find(lower(wanted)) != std::string::npos) return i;
  }
  std::string list;
  for (const auto& info : infos) list += "\n  " + std::to_string(info.index) + ": " + info.name;
  throw bad_value("device", "no Vulkan device \"" + wanted + "\"; there are:" + list);
}

/// A driver on the processor allocates what it sorts into tiles, and frees it, with every pass; by
/// default glibc hands such memory to the system at once and takes it again page by page.
void keep_freed_memory() {
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that it accepts
  ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

}  // namespace

void check(VkResult result, const char* call) {
  // A size that memory does not hold is the request's fault; the device goes on.
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
    throw unsupported("not enough memory for this picture: " + std::string(call) + " failed");
  if (result != VK_SUCCESS)
    throw device_error(std::string(call) + ": " + name_of(result) + " (" + std::to_string(result) +
                       ")");
}

Device::Device(const RendererOptions& options) {
  const bool debug_utils = instance_extension_present(
      VK_EXT_DEBUG_UTILS_EXTENSION_NAME, options.validation ? validation_layer : nullptr);
  instance_ = create_instance(options.validation, debug_utils);
  try {
    if (options.validation && debug_utils) {
      VkDebugUtilsMessengerCreateInfoEXT create{
          VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
      create.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
      create.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
      create.pfnUserCallback = collect_message;
      create.pUserData = &log_;
      const auto create_messenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
          vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
      check(create_messenger(instance_, &create, nullptr, &messenger_),
            "vkCreateDebugUtilsMessengerEXT");
    }
    const auto devices = physical_devices(instance_);
    std::vector<DeviceInfo> infos;
    for (std::uint32_t i = 0; i < devices.size(); ++i) infos.push_back(describe(devices[i], i));
    const std::size_t index = choose(infos, options.device);
    physical = devices[index];
    info = infos[index];
    if (info.type == "cpu") keep_freed_memory();
    vkGetPhysicalDeviceProperties(physical, &properties);
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    create_logical_device();
    if (debug_utils) {
      begin_label = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
          vkGetInstanceProcAddr(instance_, "vkCmdBeginDebugUtilsLabelEXT"));
      end_label = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
          vkGetInstanceProcAddr(instance_, "vkCmdEndDebugUtilsLabelEXT"));
    }
  } catch (...) {
    release();
    throw;
  }
}

Device::Offered Device::offered_features() const {
  Offered offered{};
  VkPhysicalDeviceVulkan13Features& has13 = offered.since13;
  VkPhysicalDeviceVulkan12Features& has12 = offered.since12;
  has13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  has12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  has12.pNext = &has13;
  VkPhysicalDeviceFeatures2 has{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &has12, {}};
  vkGetPhysicalDeviceFeatures2(physical, &has);
  offered.core = has.features;
  has12.pNext = nullptr;
  return offered;
}

void Device::choose_features(const Offered& offered) {
  const VkPhysicalDeviceFeatures& has = offered.core;
  const auto need = [&](VkBool32 present, const char* name) {
    if (!present) throw device_error(info.name + " lacks the feature " + name);
  };
  need(offered.since13.dynamicRendering, "dynamicRendering");
  need(offered.since13.synchronization2, "synchronization2");
  need(has.geometryShader, "geometryShader");
  need(has.depthClamp, "depthClamp");
  need(has.pipelineStatisticsQuery, "pipelineStatisticsQuery");
  need(has.independentBlend, "independentBlend");
  need(has.fragmentStoresAndAtomics, "fragmentStoresAndAtomics");
  need(has.shaderClipDistance, "shaderClipDistance");
  need(has.shaderStorageImageWriteWithoutFormat, "shaderStorageImageWriteWithoutFormat");
  need(has.shaderStorageImageExtendedFormats, "shaderStorageImageExtendedFormats");

  features.geometryShader = VK_TRUE;
  features.depthClamp = VK_TRUE;
  features.pipelineStatisticsQuery = VK_TRUE;
  features.independentBlend = VK_TRUE;
  features.fragmentStoresAndAtomics = VK_TRUE;
  features.shaderClipDistance = VK_TRUE;
  features.shaderStorageImageWriteWithoutFormat = VK_TRUE;
  features.shaderStorageImageExtendedFormats = VK_TRUE;
  features.imageCubeArray = has.imageCubeArray;
  features.samplerAnisotropy = has.samplerAnisotropy;
  features.shaderFloat64 = has.shaderFloat64;
  features.shaderInt64 = has.shaderInt64;
  features.occlusionQueryPrecise = has.occlusionQueryPrecise;
  features.shaderStorageImageReadWithoutFormat = has.shaderStorageImageReadWithoutFormat;
  features.fillModeNonSolid = has.fillModeNonSolid;
}

std::uint32_t Device::find_queue_family() const {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  constexpr VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (std::uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & wanted) == wanted && families[i].timestampValidBits > 0) return i;
  throw device_error(info.name + " has no queue with graphics, compute and timestamps");
}

void Device::create_logical_device() {
  if (properties.apiVersion < VK_API_VERSION_1_3)
    throw device_error(info.name + " offers no Vulkan 1.3");
  const Offered offered = offered_features();
  choose_features(offered);
  queue_family = find_queue_family();

  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue_create{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_create.queueFamilyIndex = queue_family;
  queue_create.queueCount = 1;
  queue_create.pQueuePriorities = &priority;

  VkPhysicalDeviceVulkan13Features use13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  use13.dynamicRendering = VK_TRUE;
  use13.synchronization2 = VK_TRUE;
  use13.maintenance4 = offered.since13.maintenance4;
  use13.shaderDemoteToHelperInvocation = offered.since13.shaderDemoteToHelperInvocation;
  VkPhysicalDeviceVulkan12Features use12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  use12.pNext = &use13;
  use12.hostQueryReset = offered.since12.hostQueryReset;
  VkPhysicalDeviceFeatures2 use{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &use12, features};

  const char* extensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  VkDeviceCreateInfo create{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  create.pNext = &use;
  create.queueCreateInfoCount = 1;
  create.pQueueCreateInfos = &queue_create;
  create.enabledExtensionCount = 1;
  create.ppEnabledExtensionNames = extensions;
  check(vkCreateDevice(physical, &create, nullptr, &handle), "vkCreateDevice");
  vkGetDeviceQueue(handle, queue_family, 0, &queue);
  push_descriptors = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
      vkGetDeviceProcAddr(handle, "vkCmdPushDescriptorSetKHR"));
}

Device::~Device() {
  release();
}

void Device::release() {
  if (handle != VK_NULL_HANDLE) {
    vkDeviceWaitIdle(handle);
    one_time = {};
    vkDestroyDevice(handle, nullptr);
    handle = VK_NULL_HANDLE;
  }
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
    messenger_ = VK_NULL_HANDLE;
  }
  if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
  instance_ = VK_NULL_HANDLE;
}

std::uint32_t Device::memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags wanted,
                                  VkMemoryPropertyFlags preferred) const {
  for (const VkMemoryPropertyFlags flags : {wanted | preferred, wanted})
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((type_bits >> i & 1u) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags)
        return i;
  throw device_error("no memory type fits");
}

DeviceLimits Device::limits() const {
  VkDeviceSize heap = 0;
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0)
      heap = std::max(heap, memory.memoryHeaps[i].size);
  const std::uint64_t machine = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) *
                                static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  return {info.type == "cpu" ? machine : heap, heap, properties.limits.maxStorageBufferRange,
          properties.limits.maxImageDimension2D};
}

void Device::throw_if_validation_failed() {
  const std::lock_guard lock(log_.mutex);
  if (log_.messages.empty()) return;
  std::string text = "validation layer: " + log_.messages.front();
  if (log_.messages.size() > 1)
    text += " (and " + std::to_string(log_.messages.size() - 1) + " more)";
  log_.messages.clear();
  throw device_error(text);
}

}  // namespace penumbra::vulkan

namespace penumbra {

std::vector<DeviceInfo> list_devices() {
  using namespace vulkan;
  VkInstance instance = create_instance(false, false);
  std::vector<DeviceInfo> infos;
  try {
    const auto devices = physical_devices(instance);
    for (std::uint32_t i = 0; i < devices.size(); ++i) infos.push_back(describe(devices[i], i));
  } catch (...) {
    vkDestroyInstance(instance, nullptr);
    throw;
  }
  vkDestroyInstance(instance, nullptr);
  return infos;
}

}  // namespace penumbra
