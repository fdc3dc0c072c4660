#pragma once

#include "renderer/frame/geometry_buffer.h"
#include "renderer/frame/uncertainty.h"
#include "renderer/frame/window.h"

namespace penumbra {

/// What a window of a picture is drawn into besides the geometry buffer.
struct FrameTargets {
  struct Wanted {
    bool stencil = false;     ///< beside the geometry buffer's depth
    bool emitted = false;     ///< in the geometry buffer
    bool radiance = false;    ///< of several lights or samples, before it is resolved
    bool light_sums = false;  ///< for lights of many points
    bool uncertainty = false;
    bool linear = false;  ///< the picture before it is encoded
    bool diagnostic = false;
    std::uint32_t visibility_layers = 0;  ///< one a light, or none
  };

  FrameTargets(vulkan::Device& device, const Window& window, std::uint32_t side,
               const Wanted& wanted);

  vulkan::MemoryLedger ledger;
  GeometryBuffer geometry;
  vulkan::Image picture;             ///< encoded; by pixel, as are those below unless noted
  vulkan::Image linear;              ///< with exposure, or none
  vulkan::Image radiance;            ///< linear light of the lights so far, by sample
  vulkan::Image light_sums;          ///< radiance and visibility of the light at hand, by sample
  vulkan::Image visibility_samples;  ///< of the light at hand
  vulkan::Image visibility;          ///< a layer a light
  vulkan::Image diagnostic;          ///< by sample
  std::unique_ptr<Uncertainty> uncertainty;

  static constexpr VkFormat picture_format = VK_FORMAT_R8G8B8A8_UNORM;
  static constexpr VkFormat radiance_format = VK_FORMAT_R32G32B32A32_SFLOAT;
  static constexpr VkFormat linear_format = VK_FORMAT_R32G32B32A32_SFLOAT;
  static constexpr VkFormat visibility_format = VK_FORMAT_R32G32_SFLOAT;
};

}  // namespace penumbra
