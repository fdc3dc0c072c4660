#pragma once

#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::shadow_maps {

/// Least depth over squares of 2, 4, 8 .. texels of a depth map, so that a shader can bound what
/// stands before a region in a few reads (Guennebaud, Barthe and Paulin 2006). Tiles have none.
class NearestDepths {
 public:
  /// What it allocates beside the depth map.
  static void require(const TechniqueInput& input, Requirements& needs);

  /// One pass, "nearest depths". Takes half as many bytes as the map if its size is a power of two.
  void draw(PrepareContext& context, const DepthMap& depth);

  /// Name for renderer/shadow_maps/filters/nearest_depths.glsl: "nearest_depths".
  void bind(vulkan::Bindings& bindings) const;

 private:
  vulkan::Image image_;  ///< all levels side by side
};

}  // namespace penumbra::shadow_maps
