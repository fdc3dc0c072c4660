#pragma once

#include "renderer/frame/prepare_context.h"
#include "renderer/shadow_maps/light_view.h"

namespace penumbra::shadow_maps {

/// Parameters of every technique that draws a depth map: map_size, layout, bias_strategy, bias,
/// slope_scale. Techniques append their own.
std::vector<Parameter> map_parameters();

/// A single linear depth map per light: what map techniques are composed from. Depth is the
/// distance along the map's axis, 0 at near and 1 at far, written per fragment; D32, one layer a
/// face.
class DepthMap {
 public:
  /// Draws the map for this frame. `kernel_radius` in texels is how far the filter reads from the
  /// receiver's place; the bias of strategy slope follows it. The map is wider than what it serves
  /// by `border` texels.
  void draw(PrepareContext& context, double kernel_radius, double border);
  void draw(PrepareContext& context, double kernel_radius) {
    draw(context, kernel_radius, kernel_radius);
  }

  /// Names for renderer/shadow_maps/depth_map.glsl: "shadow_map" and "MapBlock".
  void bind(vulkan::Bindings& bindings,
            vulkan::Sampling sampling = vulkan::Sampling::nearest) const;

  const vulkan::Image& image() const { return image_; }
  const vulkan::BufferRange& constants() const { return constants_; }

 private:
  vulkan::Image image_;
  vulkan::BufferRange constants_;
};

}  // namespace penumbra::shadow_maps
