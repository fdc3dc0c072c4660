#include "renderer/error.h"
#include "renderer/shadow_maps/filters/prefiltered_map.h"

namespace penumbra::techniques {
namespace {

std::vector<Parameter> esm_parameters() {
  std::vector<Parameter> list = shadow_maps::map_parameters();
  for (const Parameter& parameter : shadow_maps::blur_parameters()) list.push_back(parameter);
  list.push_back(real("c", 80.0, {1.0, 1000.0},
                      "Steepness of the exponential over the map's range. Higher: less light leaks "
                      "in at contacts. Linear filtering overflows above 88.7, with fp16 above 11.")
                     .log());
  list.push_back(
      choice("filtering", "linear", {"linear", "logarithmic"},
             "What the map holds. linear: exp(c z), which samplers may filter. logarithmic: c z, "
             "filtered by the shader alone, so without mips; no c overflows.")
          .compiled());
  list.push_back(
      choice("fallback", "threshold", {"none", "threshold", "z-max"},
             "Where something in the kernel lies behind the receiver, 2x2 comparisons take over. "
             "threshold: where the result passes 1. z-max: where the kernel's greatest depth does.")
          .compiled());
  list.push_back(real("threshold", 0.02, {0.0, 1000.0},
                      "What the result may pass 1 by before the fallback is taken."));
  list.push_back(shadow_maps::precision_parameter(
      "Bits of a texel. 16 overflow above c 11 with linear filtering, and round c z coarsely with "
      "logarithmic."));
  return list;
}

/// Exponential shadow maps: the comparison is replaced by a steep exponential, which factors into a
/// part of the caster that may be filtered and one of the receiver.
class ExponentialShadowMap : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    shadow_maps::PrefilteredMap::require(input, exponential_settings(input.parameters), needs);
    if (keeps_farthest(input.parameters))
      shadow_maps::BlurredMap::require(input, farthest_settings(), needs);
    if (choice_of(input.parameters, "filtering") == "linear") return;
    for (const char* name : {"mips", "anisotropic"})
      if (boolean_of(input.parameters, name))
        throw unsupported(std::string("logarithmic filtering knows no ") + name +
                              ": samplers average logarithms wrongly; set it to false",
                          name);
  }

  void prepare(PrepareContext& context) override {
    const ParameterValues& parameters = context.input.parameters;
    exponentials_.draw(context, exponential_settings(parameters));
    z_max_ = keeps_farthest(parameters);
    if (z_max_) farthest_.draw(context, exponentials_.depth(), farthest_settings());
  }

  void bind(vulkan::Bindings& bindings) const override {
    exponentials_.bind(bindings);
    if (z_max_) farthest_.bind(bindings, "farthest_map");
  }

 private:
  static shadow_maps::BlurSettings exponential_settings(const ParameterValues& parameters) {
    const bool logarithmic = choice_of(parameters, "filtering") == "logarithmic";
    return {
        .encoder = "techniques/esm/encoder.glsl",
        .format = shadow_maps::float_format(parameters, 1),
        .filter = logarithmic ? shadow_maps::MapFilter::logarithmic : shadow_maps::MapFilter::mean};
  }
  static shadow_maps::BlurSettings farthest_settings() {
    return {.encoder = "techniques/esm/farthest.glsl",
            .format = VK_FORMAT_R32_SFLOAT,
            .filter = shadow_maps::MapFilter::maximum,
            .name = "farthest depths"};
  }
  static bool keeps_farthest(const ParameterValues& parameters) {
    return choice_of(parameters, "fallback") == "z-max";
  }

  shadow_maps::PrefilteredMap exponentials_;
  shadow_maps::BlurredMap farthest_;  ///< only with fallback z-max
  bool z_max_ = false;
};

}  // namespace

TechniqueDescription describe_esm() {
  TechniqueDescription description;
  description.label = "ESM";
  description.title = "Exponential shadow map";
  description.family = "map";
  description.source = "Adorjan 2013, 2.2.2 and 3.3.2; Annen et al. 2008; Salvi 2008";
  description.parameters = esm_parameters();
  description.diagnostics = shadow_maps::map_diagnostics(
      {{"moments", "Logarithm of what is stored, over c; magenta where it overflowed."},
       {"fallback", "Red where 2x2 comparisons take over, over the visibility in grey."},
       shadow_maps::mip_level_diagnostic()});
  description.create = create_technique<ExponentialShadowMap>;
  return description;
}

}  // namespace penumbra::techniques
