#include "renderer/shadow_maps/blurred_map.h"
#include "renderer/shadow_maps/summed_area.h"

namespace penumbra::techniques {
namespace {

constexpr std::int64_t largest_kernel = 129;  // texels; shadow.glsl names it too

std::vector<Parameter> savsm_parameters() {
  std::vector<Parameter> list = shadow_maps::map_parameters();
  Parameter kernel;
  kernel.name = "kernel";
  kernel.type = ParameterType::integer;
  kernel.default_value = std::int64_t{5};
  kernel.minimum = 1;
  kernel.maximum = largest_kernel;
  kernel.unit = "texels";
  kernel.meaning = "Width of the filter; any width costs the same.";
  kernel.variant = true;
  list.push_back(kernel);

  Parameter adaptive;
  adaptive.name = "adaptive";
  adaptive.type = ParameterType::boolean;
  adaptive.default_value = true;
  adaptive.meaning =
      "Widen the filter, pixel by pixel, to the texels that a pixel covers, at most 129.";
  adaptive.variant = true;
  list.push_back(adaptive);
  list.push_back(shadow_maps::table_parameter());
  list.push_back(shadow_maps::bleeding_parameter(0.2));
  list.push_back(shadow_maps::deviation_parameter());
  return list;
}

/// Summed-area variance shadow maps: moments over any square of texels in sixteen reads.
class SummedAreaVarianceShadowMap : public Technique {
 public:
  void require(const TechniqueInput&, Requirements&) override {}

  void prepare(PrepareContext& context) override {
    const ParameterValues& parameters = context.input.parameters;
    const std::int64_t kernel = integer_of(parameters, "kernel");
    depth_.draw(context, 0.5 * static_cast<double>(kernel));
    table_.draw(context, depth_, boolean_of(parameters, "adaptive") ? largest_kernel : kernel);
  }

  void bind(vulkan::Bindings& bindings) const override {
    depth_.bind(bindings);
    table_.bind(bindings);
  }

 private:
  shadow_maps::DepthMap depth_;
  shadow_maps::SummedAreaTable table_;
};

}  // namespace

TechniqueDescription describe_savsm();
TechniqueDescription describe_savsm() {
  TechniqueDescription description;
  description.id = "savsm";
  description.label = "SAVSM";
  description.title = "Summed-area variance shadow map";
  description.family = "map";
  description.source = "Adorjan 2013, 2.2.1, 3.3.4 and 3.3.5; Lauritzen 2007";
  description.parameters = savsm_parameters();
  description.diagnostics = {
      {"map", "The depth map as the light sees it: near is dark, far is bright."},
      {"moments",
       "Mean depth by the table: of one texel red, of the kernel green; the map's own depth blue."},
      {"filter-width",
       "By their logarithms: texels that a pixel covers red, width of the filter green."}};
  description.shader = "techniques/savsm/shadow.glsl";
  description.create = [] { return std::make_unique<SummedAreaVarianceShadowMap>(); };
  return description;
}

}  // namespace penumbra::techniques
