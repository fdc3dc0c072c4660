#pragma once

#include "renderer/frame/prepare_context.h"
#include "renderer/shadow_maps/light_view.h"

namespace penumbra::shadow_maps {

/// Parameters of every technique that draws a depth map: map_size, layout, bias_strategy, bias,
/// slope_scale. Techniques append their own.
std::vector<Parameter> map_parameters();

/// Those and how depth is kept, for techniques that only compare it: depth, depth_bits, near, far.
std::vector<Parameter> comparing_map_parameters();

/// The picture `map` of every program that includes renderer/shadow_maps/diagnostics.glsl.
Diagnostic map_diagnostic();

/// A single depth map per light: what map techniques are composed from. Depth is the distance along
/// the map's axis, 0 at near and 1 at far, written per fragment, even in 32 bits unless parameters
/// ask for less; one layer a face. Bias strategies that know two surfaces draw both and make the
/// map of them.
class DepthMap {
 public:
  /// What it allocates.
  static void require(const TechniqueInput& input, Requirements& needs);

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
  void draw_casters(PrepareContext& context, const LightView& view, const vulkan::Image& target,
                    const std::string& layer) const;
  void draw_layers(PrepareContext& context, const LightView& view);

  vulkan::Image image_;
  vulkan::Image first_;   ///< nearest surfaces, for strategies that know two
  vulkan::Image second_;  ///< those behind them
  vulkan::BufferRange constants_;
};

}  // namespace penumbra::shadow_maps
