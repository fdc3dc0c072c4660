#include "renderer/shadow_maps/filters/blurred_map.h"
#include "renderer/shadow_maps/filters/summed_area.h"

namespace penumbra::techniques {
namespace {

std::vector<Parameter> savsm_parameters() {
  std::vector<Parameter> list = shadow_maps::map_parameters();
  for (const Parameter& parameter : shadow_maps::summed_area_parameters())
    list.push_back(parameter);
  list.push_back(shadow_maps::bleeding_parameter(0.2));
  list.push_back(shadow_maps::deviation_parameter());
  return list;
}

/// Summed-area variance shadow maps: moments over any square of texels in sixteen reads.
class SummedAreaVarianceShadowMap : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    shadow_maps::DepthMap::require(input, needs);
    shadow_maps::SummedAreaTable::require(input, needs);
  }

  void prepare(PrepareContext& context) override {
    const std::int64_t kernel = integer_of(context.input.parameters, "kernel");
    depth_.draw(context,
                {.kernel_radius = 0.5 * static_cast<double>(kernel), .common_range = true});
    table_.draw(context, depth_);
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

TechniqueDescription describe_savsm() {
  TechniqueDescription description;
  description.label = "SAVSM";
  description.title = "Summed-area variance shadow map";
  description.family = "map";
  description.source = "Adorjan 2013, 2.2.1, 3.3.4 and 3.3.5; Lauritzen 2007";
  description.parameters = savsm_parameters();
  description.diagnostics = shadow_maps::map_diagnostics(
      {{"moments",
        "Mean depth by the table: of one texel red, of the kernel green; the map's own depth "
        "blue."},
       {"filter-width",
        "By their logarithms: texels that a pixel covers red, width of the filter green."}});
  description.create = create_technique<SummedAreaVarianceShadowMap>;
  return description;
}

}  // namespace penumbra::techniques
