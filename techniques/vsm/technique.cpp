#include "renderer/shadow_maps/blurred_map.h"

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
  void require(const TechniqueInput&, Requirements&) override {}

  void prepare(PrepareContext& context) override {
    const ParameterValues& parameters = context.input.parameters;
    depth_.draw(context, static_cast<double>(integer_of(parameters, "blur")) + 0.5);
    const bool half = choice_of(parameters, "precision") == "fp16";
    shadow_maps::BlurSettings settings;
    settings.encoder = "techniques/vsm/moments.frag";
    settings.format = half ? VK_FORMAT_R16G16_SFLOAT : VK_FORMAT_R32G32_SFLOAT;
    moments_.draw(context, depth_, settings);
  }

  void bind(vulkan::Bindings& bindings) const override {
    depth_.bind(bindings);
    moments_.bind(bindings);
  }

 private:
  shadow_maps::DepthMap depth_;
  shadow_maps::BlurredMap moments_;
};

}  // namespace

TechniqueDescription describe_vsm();
TechniqueDescription describe_vsm() {
  TechniqueDescription description;
  description.id = "vsm";
  description.label = "VSM";
  description.title = "Variance shadow map";
  description.family = "map";
  description.source = "van Sambeek 2007, 2.2.6; Donnelly and Lauritzen 2006";
  description.parameters = vsm_parameters();
  description.diagnostics = {
      {"map", "The depth map as the light sees it: near is dark, far is bright."},
      {"moments", "Mean depth in red and ten times the deviation from it in green."},
      {"mip-level", "Level that each pixel reads: 0 red, 1 yellow, 2 green, 3 and above blue."}};
  description.shader = "techniques/vsm/shadow.glsl";
  description.create = [] { return std::make_unique<VarianceShadowMap>(); };
  return description;
}

}  // namespace penumbra::techniques
