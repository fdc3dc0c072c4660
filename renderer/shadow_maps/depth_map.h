#pragma once

#include "renderer/frame/prepare_context.h"
#include "renderer/shadow_maps/layout.h"
#include "renderer/shadow_maps/texels/tiles.h"
#include "renderer/shadow_maps/views/seen_samples.h"

namespace penumbra::shadow_maps {

/// Parameters of every technique that draws a depth map: map_size, layout and those of every
/// layout, bias_strategy, bias, slope_scale. Techniques append their own.
std::vector<Parameter> map_parameters();

/// Those and how depth is kept, for techniques that only compare it: depth, depth_bits, near, far.
std::vector<Parameter> comparing_map_parameters();

/// Pictures of every program that includes renderer/shadow_maps/diagnostics.glsl, and those of
/// one's own.
std::vector<Diagnostic> map_diagnostics(const std::vector<Diagnostic>& own = {});

/// Whether the layout keeps depths in an image, rather than in a buffer of tiles.
bool keeps_image(const ParameterValues& parameters);

/// Throws `unsupported` where the layout keeps no image of the map; `needed` says what for, as in
/// "which a sampler cannot compare with".
void require_image(const TechniqueInput& input, const std::string& needed);

/// Views of the light's map, each a layer of its images.
std::uint32_t view_count(const TechniqueInput& input);

/// The depth map of a light: what map techniques are composed from. Depth is the distance along a
/// view's axis, 0 at near and 1 at far, written per fragment, even in 32 bits unless parameters ask
/// for less; one layer for each view of the layout, or one buffer for all tiles. Bias strategies
/// that know two surfaces draw both and make the map of them.
class DepthMap {
 public:
  /// What it allocates. Throws `unsupported` for a light that the layout cannot serve.
  static void require(const TechniqueInput& input, Requirements& needs);

  /// Draws the map for this frame.
  void draw(PrepareContext& context, const MapUse& use);

  /// Names for renderer/shadow_maps/depth_map.glsl: "shadow_map" or "MapTexelBlock", and
  /// "MapBlock".
  void bind(vulkan::Bindings& bindings,
            vulkan::Sampling sampling = vulkan::Sampling::nearest) const;

  /// Empty where a layout of tiles keeps depths in a buffer.
  const vulkan::Image& image() const { return image_; }
  const vulkan::BufferRange& constants() const { return constants_; }

 private:
  using Views = std::vector<shader::MapView>;
  void draw_casters(PrepareContext& context, const Views& views, const vulkan::Image& target,
                    const std::string& layer) const;
  void draw_layers(PrepareContext& context, const Views& views);
  Views fit_views(PrepareContext& context, const MapUse& use);

  vulkan::Image image_;
  vulkan::Image first_;   ///< nearest surfaces, for strategies that know two
  vulkan::Image second_;  ///< those behind them
  vulkan::BufferRange constants_;
  SeenSamples seen_;
  Tiles tiles_;
};

/// A technique that draws a depth map for every light; what it is for is said by its GLSL.
class MapTechnique : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    DepthMap::require(input, needs);
  }
  void prepare(PrepareContext& context) override {
    map_.draw(context, map_use(context.input.parameters));
  }
  void bind(vulkan::Bindings& bindings) const override { map_.bind(bindings); }

 protected:
  /// How the GLSL reads the map; by default one comparison at the receiver's place.
  virtual MapUse map_use(const ParameterValues&) const { return {}; }

  DepthMap map_;
};

}  // namespace penumbra::shadow_maps
