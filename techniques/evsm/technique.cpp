#include "renderer/shadow_maps/filters/prefiltered_map.h"

namespace penumbra::techniques {
namespace {

Parameter constant_parameter(const char* name, double value, const char* meaning) {
  return real(name, value, {1.0, 1000.0}, meaning).log();
}

std::vector<Parameter> evsm_parameters() {
  std::vector<Parameter> list = shadow_maps::map_parameters();
  for (const Parameter& parameter : shadow_maps::blur_parameters()) list.push_back(parameter);
  list.push_back(constant_parameter(
      "c_positive", 30.0,
      "Steepness of the warp exp(c z) over the map's range. Higher: less bleeding between casters. "
      "Its square overflows above 44.3, with fp16 above 5.5."));
  list.push_back(constant_parameter(
      "c_negative", 10.0,
      "Steepness of the warp -exp(c (1/2 - z)), which mends surfaces that slope within the kernel. "
      "Its square overflows above 88.7, with fp16 above 11."));
  list.push_back(choice("components", "4", {"2", "4"},
                        "Moments in a texel: those of the positive warp, or of both.")
                     .compiled());
  list.push_back(shadow_maps::precision_parameter(
      "Bits of a moment. 16 overflow above c_positive 5.5, too little to stop bleeding."));
  list.push_back(shadow_maps::bleeding_parameter(0.0));
  list.push_back(shadow_maps::deviation_parameter());
  return list;
}

/// Exponential variance shadow maps: bounds by the moments of depth under two warps, of which the
/// smaller holds.
class ExponentialVarianceShadowMap : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    shadow_maps::PrefilteredMap::require(input, map_settings(input.parameters), needs);
  }

  void prepare(PrepareContext& context) override {
    map_.draw(context, map_settings(context.input.parameters));
  }

  void bind(vulkan::Bindings& bindings) const override { map_.bind(bindings); }

 private:
  static shadow_maps::BlurSettings map_settings(const ParameterValues& parameters) {
    const int components = choice_of(parameters, "components") == "4" ? 4 : 2;
    return {.encoder = "techniques/evsm/encoder.glsl",
            .format = shadow_maps::float_format(parameters, components)};
  }

  shadow_maps::PrefilteredMap map_;
};

}  // namespace

TechniqueDescription describe_evsm() {
  TechniqueDescription description;
  description.label = "EVSM";
  description.title = "Exponential variance shadow map";
  description.family = "map";
  description.source = "Adorjan 2013, 2.2.3; Lauritzen and McCool 2008";
  description.parameters = evsm_parameters();
  description.diagnostics = shadow_maps::map_diagnostics(
      {{"moments", "Mean depth by either warp, red and green; magenta where a moment overflowed."},
       shadow_maps::mip_level_diagnostic()});
  description.create = create_technique<ExponentialVarianceShadowMap>;
  return description;
}

}  // namespace penumbra::techniques
