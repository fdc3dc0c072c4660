#include "renderer/shadow_maps/filters/prefiltered_map.h"

namespace penumbra::techniques {
namespace {

std::vector<Parameter> msm_parameters() {
  std::vector<Parameter> list = shadow_maps::map_parameters();
  for (const Parameter& parameter : shadow_maps::blur_parameters()) list.push_back(parameter);
  list.push_back(choice("precision", "fp32", {"unorm16", "fp32"},
                        "What a moment is kept in: 64 or 128 bits a texel. unorm16 asks for a "
                        "moment_bias of 6e-5 or more.")
                     .compiled());
  list.push_back(real("moment_bias", 3e-5, {0.0, 0.1},
                      "Share of moments of scattered depths that is mixed in, so that rounding "
                      "leaves moments which depths can have. More: more bleeding."));
  list.push_back(shadow_maps::bleeding_parameter(0.05));
  return list;
}

/// Moment shadow maps: four moments of depth bound the light from above more tightly than two.
class MomentShadowMap : public Technique {
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
    const bool unorm16 = choice_of(parameters, "precision") == "unorm16";
    return {.encoder = "techniques/msm/encoder.glsl",
            .format = unorm16 ? VK_FORMAT_R16G16B16A16_UNORM : VK_FORMAT_R32G32B32A32_SFLOAT};
  }

  shadow_maps::PrefilteredMap map_;
};

}  // namespace

TechniqueDescription describe_msm() {
  TechniqueDescription description;
  description.label = "MSM";
  description.title = "Moment shadow map";
  description.family = "map";
  description.source = "Peters and Klein 2015, four moments, Hamburger problem";
  description.parameters = msm_parameters();
  description.diagnostics = shadow_maps::map_diagnostics(
      {{"moments", "Mean depth in red and ten times the deviation from it in green."},
       shadow_maps::mip_level_diagnostic()});
  description.create = create_technique<MomentShadowMap>;
  return description;
}

}  // namespace penumbra::techniques
