// A complete technique, small enough to copy: scripts/new-technique does. It is compiled and passes
// the conformance tests, but the build does not offer it.
#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::techniques {
namespace {

/// A shadow map whose comparison ramps over a range of depth instead of stepping.
class Template : public Technique {
 public:
  /// Say here what must exist before anything is drawn (stencil, adjacency, light points, ...), and
  /// throw unsupported("why", "field") for a light or scene that cannot be served.
  void require(const TechniqueInput& input, Requirements& needs) override {
    shadow_maps::DepthMap::require(input, needs);
  }

  /// Once per frame and batch of light points. Allocate on first use, draw inside context.pass.
  void prepare(PrepareContext& context) override { map_.draw(context, {}); }

  /// Every name that shadow.glsl reads, and no other.
  void bind(vulkan::Bindings& bindings) const override { map_.bind(bindings); }

 private:
  shadow_maps::DepthMap map_;
};

}  // namespace

TechniqueDescription describe_template();
TechniqueDescription describe_template() {
  TechniqueDescription description;
  description.id = "template";
  description.label = "TPL";
  description.title = "Shadow map with a depth ramp";
  description.family = "map";
  description.source = "none: an example";
  description.parameters = shadow_maps::map_parameters();
  // GLSL reads this as parameter_ramp; validation, the JSON Schema and the web form follow from it.
  Parameter ramp;
  ramp.name = "ramp";
  ramp.default_value = 0.01;
  ramp.minimum = 0.0001;
  ramp.maximum = 1.0;
  ramp.scale = ParameterScale::logarithmic;
  ramp.unit = "m";
  ramp.meaning = "Depth behind a caster over which its shadow darkens.";
  description.parameters.push_back(ramp);
  description.diagnostics = {
      {"depth", "Distance from the light, as a fraction of the map's range."}};
  description.shader = "techniques/template/shadow.glsl";
  description.create = [] { return std::make_unique<Template>(); };
  return description;
}

}  // namespace penumbra::techniques
