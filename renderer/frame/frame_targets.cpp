#include "renderer/frame/frame_targets.h"

#include "renderer/frame/scene_pass.h"

namespace penumbra {

FrameTargets::FrameTargets(vulkan::Device& device, const Window& window, std::uint32_t side,
                           const Wanted& wanted) {
  const auto make = [&](const char* name, VkFormat format, std::uint32_t scale,
                        VkImageUsageFlags further = 0, std::uint32_t layers = 1) {
    vulkan::ImageDescription description;
    description.format = format;
    description.width = window.width * scale;
    description.height = window.height * scale;
    description.layers = layers;
    description.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | further;
    return vulkan::Image(device, ledger, name, description);
  };
  geometry = make_geometry_buffer(device, ledger, window.width * side, window.height * side,
                                  wanted.stencil, wanted.emitted);
  picture = make("picture", picture_format, 1);
  if (wanted.linear)
    linear = make("linear picture", linear_format, 1, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  if (wanted.radiance) radiance = make("radiance", radiance_format, side);
  if (wanted.light_sums)
    light_sums = make("light sums", linear_format, side, VK_IMAGE_USAGE_STORAGE_BIT);
  if (wanted.uncertainty)
    uncertainty = std::make_unique<Uncertainty>(device, ledger, window.width, window.height, side);
  if (wanted.visibility_layers > 0) {
    visibility_samples = make("visibility samples", visibility_format, side);
    visibility = make("visibility", visibility_format, 1, 0, wanted.visibility_layers);
  }
  if (wanted.diagnostic) diagnostic = make("diagnostic", picture_format, side);
}

}  // namespace penumbra
