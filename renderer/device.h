#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra {

struct DeviceInfo {
  std::string name;
  std::string driver;  ///< name and version
  std::string type;    ///< cpu, integrated, discrete, virtual, other
  std::uint32_t index = 0;
};

/// What a device can hold, bytes unless said otherwise.
struct DeviceLimits {
  std::uint64_t memory = 0;          ///< in all
  std::uint64_t light = 0;           ///< of what is allocated for one light: a heap of the device
  std::uint64_t storage_buffer = 0;  ///< one of them
  std::uint32_t image_extent = 0;    ///< texels along an edge
};

/// All Vulkan devices of this machine, in the loader's order.
std::vector<DeviceInfo> list_devices();

struct RendererOptions {
  std::string device;  ///< part of a name, or an index; empty: a GPU, lavapipe where there is none
  bool validation = false;  ///< turn the validation layer on; its messages fail the render
  /// Pictures with more samples are drawn window by window, so that memory for their size is there.
  std::uint64_t most_window_samples = std::uint64_t{1} << 24;
};

/// Device memory that something takes.
struct ResourceCost {
  std::string name;
  std::uint64_t bytes = 0;
};

}  // namespace penumbra
