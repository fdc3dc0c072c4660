#pragma once

#include "renderer/image.h"
#include "renderer/vulkan/commands.h"

namespace penumbra {

/// Copies one layer of an 8-bit RGBA image to the host.
Image8 read_rgba8(vulkan::Device& device, const vulkan::Image& image, std::uint32_t layer = 0);

/// Copies one layer of a 32-bit float image with `channels` components to the host.
ImageF read_float(vulkan::Device& device, const vulkan::Image& image, std::uint32_t channels,
                  std::uint32_t layer = 0);

/// Copies a picture to layer 0 of a 32-bit float image of its size and components.
void write_float(vulkan::Device& device, const vulkan::Image& image, const ImageF& content);

}  // namespace penumbra
