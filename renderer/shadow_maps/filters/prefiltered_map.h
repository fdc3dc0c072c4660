#pragma once

#include "renderer/shadow_maps/filters/blurred_map.h"

namespace penumbra::shadow_maps {

/// Floats of the bits that parameter `precision` asks for, 1, 2 or 4 of them in a texel.
VkFormat float_format(const ParameterValues& parameters, int components);

/// A depth map and the blurred map made of it: what techniques are composed from that filter a map
/// before it is read.
class PrefilteredMap {
 public:
  static void require(const TechniqueInput& input, const BlurSettings& settings,
                      Requirements& needs);
  void draw(PrepareContext& context, const BlurSettings& settings);
  void bind(vulkan::Bindings& bindings) const;

  const DepthMap& depth() const { return depth_; }

 private:
  DepthMap depth_;
  BlurredMap blurred_;
};

}  // namespace penumbra::shadow_maps
