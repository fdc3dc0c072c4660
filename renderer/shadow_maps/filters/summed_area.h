#pragma once

#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::shadow_maps {

/// Parameters of techniques that read a summed-area table: kernel, adaptive, table.
std::vector<Parameter> summed_area_parameters();

/// Sums of a depth map's first two moments over all rectangles that begin at its corner.
class SummedAreaTable {
 public:
  /// What it allocates beside the depth map.
  static void require(const TechniqueInput& input, Requirements& needs);

  /// Two passes, "sum rows" and "sum columns". Throws `unsupported` for table fp64 where the device
  /// has no doubles.
  void draw(PrepareContext& context, const DepthMap& depth);

  /// Name for renderer/shadow_maps/filters/summed_area.glsl: "SummedAreaBlock".
  void bind(vulkan::Bindings& bindings) const;

 private:
  vulkan::Buffer table_;
};

}  // namespace penumbra::shadow_maps
