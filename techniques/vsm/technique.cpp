#include "renderer/shadow_maps/filters/prefiltered_map.h"

namespace penumbra::techniques {
namespace {

std::vector<Parameter> vsm_parameters() {
  std::vector<Parameter> list = shadow_maps::map_parameters();
  for (const Parameter& parameter : shadow_maps::blur_parameters()) list.push_back(parameter);
  list.push_back(shadow_maps::precision_parameter(
      "Bits of a moment. 16 are too few for the second: shadows show bands."));
  list.push_back(shadow_maps::bleeding_parameter(0.2));
  list.push_back(shadow_maps::deviation_parameter());
  return list;
}

/// Variance shadow maps: a map of moments is filtered once, and bounds the light from above.
class VarianceShadowMap : public Technique {
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
    return {.encoder = "techniques/vsm/encoder.glsl",
            .format = shadow_maps::float_format(parameters, 2)};
  }

  shadow_maps::PrefilteredMap map_;
};

}  // namespace

TechniqueDescription describe_vsm() {
  TechniqueDescription description;
  description.label = "VSM";
  description.title = "Variance shadow map";
  description.family = "map";
  description.source = "van Sambeek 2007, 2.2.6; Donnelly and Lauritzen 2006";
  description.parameters = vsm_parameters();
  description.diagnostics = shadow_maps::map_diagnostics(
      {{"moments", "Mean depth in red and ten times the deviation from it in green."},
       shadow_maps::mip_level_diagnostic()});
  description.create = create_technique<VarianceShadowMap>;
  return description;
}

}  // namespace penumbra::techniques
