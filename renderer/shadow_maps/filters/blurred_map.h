#pragma once

#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::shadow_maps {

/// Parameters of techniques that filter a map before it is read: blur, blur_filter, mips,
/// anisotropic. Techniques append their own.
std::vector<Parameter> blur_parameters();

/// `bleeding_reduction`: how much dim light is taken for bleeding.
Parameter bleeding_parameter(double default_value);

/// `minimum_deviation`, a share of the map's range: hides rounding of moments.
Parameter deviation_parameter();

/// `precision`: fp16 or fp32, for formats of a map. `meaning` says what fails with fewer bits.
Parameter precision_parameter(const std::string& meaning);

/// The picture `mip-level` of every program that includes
/// renderer/shadow_maps/filters/blurred_map.glsl.
Diagnostic mip_level_diagnostic();

enum class MapFilter {
  mean,
  logarithmic,  ///< of logarithms: that of the mean of what they encode. No mips.
  maximum,      ///< of all texels that the blur reads. No mips.
};

/// What a map is made of.
struct BlurSettings {
  std::string encoder;  ///< path of GLSL that defines `vec4 encode_depth(float)`, of a depth from
                        ///< 0 to 1; the technique's shader includes it, too
  VkFormat format = VK_FORMAT_UNDEFINED;
  MapFilter filter = MapFilter::mean;
  std::string name = "blurred map";  ///< in the memory report
};

/// Runs along rows, which reads and encodes a depth map, then along columns.
inline constexpr const char* blur_program = "renderer/shadow_maps/filters/blurred_map.comp";

/// What goes before it for a map of this format.
std::string blur_definitions(VkFormat format);

/// What goes before it where it reads depths and encodes them.
std::string encoding(const std::string& encoder);

/// Runs it over a view of as many texels a side.
void dispatch_blur(vulkan::Commands& commands, std::uint32_t size);

/// A map of values that may be averaged, made of a depth map and blurred: moments, exponentials.
/// Same views as the depth map, one layer each, with a mip chain where parameter mips asks for one.
/// Of a layout that keeps depths in a buffer none is made: the shader encodes and filters what it
/// reads.
class BlurredMap {
 public:
  /// What it allocates beside the depth map.
  static void require(const TechniqueInput& input, const BlurSettings& settings,
                      Requirements& needs);

  /// Two passes, "encode and blur" along rows and "blur" along columns, then "mips".
  void draw(PrepareContext& context, const DepthMap& depth, const BlurSettings& settings);

  /// Name for renderer/shadow_maps/filters/blurred_map.glsl: "blurred_map"; none where none was
  /// made.
  void bind(vulkan::Bindings& bindings, const std::string& name = "blurred_map") const;

  const vulkan::Image& image() const { return image_; }

 private:
  void create(PrepareContext& context, const DepthMap& depth, const BlurSettings& settings,
              bool mips);
  void blur(PrepareContext& context, const DepthMap& depth, const BlurSettings& settings,
            std::uint32_t view);
  void reduce(vulkan::Commands& commands);

  vulkan::Image rows_;   ///< blurred along rows only
  vulkan::Image image_;  ///< blurred along both
  vulkan::Sampling sampling_ = vulkan::Sampling::linear;
};

}  // namespace penumbra::shadow_maps
