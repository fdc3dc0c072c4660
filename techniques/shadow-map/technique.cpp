#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::techniques {
namespace {

/// Hard shadows from one comparison with a linear depth map.
class ShadowMap : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    shadow_maps::DepthMap::require(input, needs);
  }
  void prepare(PrepareContext& context) override { map_.draw(context, {}); }
  void bind(vulkan::Bindings& bindings) const override { map_.bind(bindings); }

 private:
  shadow_maps::DepthMap map_;
};

}  // namespace

TechniqueDescription describe_shadow_map();
TechniqueDescription describe_shadow_map() {
  TechniqueDescription description;
  description.id = "shadow-map";
  description.label = "SSM";
  description.title = "Shadow map";
  description.family = "map";
  description.source = "van Sambeek 2007, 2.2.1-2.2.3 and 3.2.4; Williams 1978";
  description.parameters = shadow_maps::comparing_map_parameters();
  description.diagnostics = {shadow_maps::map_diagnostic(), shadow_maps::views_diagnostic()};
  description.shader = "techniques/shadow-map/shadow.glsl";
  description.create = [] { return std::make_unique<ShadowMap>(); };
  return description;
}

}  // namespace penumbra::techniques
