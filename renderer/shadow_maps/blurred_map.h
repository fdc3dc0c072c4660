#pragma once

#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::shadow_maps {

/// Parameters of techniques that filter a map before it is read: blur, blur_filter, mips,
/// anisotropic. Techniques append their own.
std::vector<Parameter> blur_parameters();

/// A map of values that may be averaged, made of a depth map and blurred: moments, exponentials.
/// Same faces as the depth map, one layer each, with a mip chain where parameter mips asks for one.
class BlurredMap {
 public:
  /// `encoder` is the path of a fragment stage that defines `vec4 encode_depth(float)`, of a depth
  /// from 0 to 1, and ENCODE, and includes blurred_map.frag.
  /// Two passes, "encode and blur" along rows and "blur" along columns, then "mips".
  void draw(PrepareContext& context, const DepthMap& depth, const std::string& encoder,
            VkFormat format);

  /// Name for renderer/shadow_maps/blurred_map.glsl: "blurred_map".
  void bind(vulkan::Bindings& bindings) const;

  const vulkan::Image& image() const { return image_; }

 private:
  void blur(PrepareContext& context, const DepthMap& depth, const std::string& encoder,
            std::uint32_t face);
  void reduce(vulkan::Commands& commands);

  vulkan::Image rows_;   ///< blurred along rows only
  vulkan::Image image_;  ///< blurred along both
  vulkan::Sampling sampling_ = vulkan::Sampling::linear;
};

}  // namespace penumbra::shadow_maps
