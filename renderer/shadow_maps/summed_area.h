#pragma once

#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::shadow_maps {

/// `table`: what sums are kept in. fp32, distributed, int32 or fp64.
Parameter table_parameter();

/// Sums of a depth map's first two moments over all rectangles that begin at its corner.
class SummedAreaTable {
 public:
  /// Two passes, "sum rows" and "sum columns". `largest_width` in texels is that of the widest
  /// rectangle that will be asked for; the shading program defines the same constant before it
  /// includes renderer/shadow_maps/summed_area.glsl. Throws `unsupported` for table fp64 where the
  /// device has no doubles.
  void draw(PrepareContext& context, const DepthMap& depth, std::int64_t largest_width);

  /// Name for renderer/shadow_maps/summed_area.glsl: "SummedAreaBlock".
  void bind(vulkan::Bindings& bindings) const;

 private:
  vulkan::Buffer table_;
};

}  // namespace penumbra::shadow_maps
