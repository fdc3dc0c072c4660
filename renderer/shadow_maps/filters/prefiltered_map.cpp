#include "renderer/shadow_maps/filters/prefiltered_map.h"

namespace penumbra::shadow_maps {

VkFormat float_format(const ParameterValues& parameters, int components) {
  const bool half = choice_of(parameters, "precision") == "fp16";
  if (components == 1) return half ? VK_FORMAT_R16_SFLOAT : VK_FORMAT_R32_SFLOAT;
  if (components == 2) return half ? VK_FORMAT_R16G16_SFLOAT : VK_FORMAT_R32G32_SFLOAT;
  return half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

void PrefilteredMap::require(const TechniqueInput& input, const BlurSettings& settings,
                             Requirements& needs) {
  DepthMap::require(input, needs);
  BlurredMap::require(input, settings, needs);
}

void PrefilteredMap::draw(PrepareContext& context, const BlurSettings& settings) {
  // A sampler interpolates: it reads half a texel beyond the blur.
  const auto blur = static_cast<double>(integer_of(context.input.parameters, "blur"));
  depth_.draw(context, {.kernel_radius = blur + 0.5, .common_range = true});
  blurred_.draw(context, depth_, settings);
}

void PrefilteredMap::bind(vulkan::Bindings& bindings) const {
  depth_.bind(bindings);
  blurred_.bind(bindings);
}

}  // namespace penumbra::shadow_maps
