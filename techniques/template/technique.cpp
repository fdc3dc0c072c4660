// A complete technique, small enough to copy: scripts/new-technique does. It is compiled and passes
// the conformance tests, but the build does not offer it.
#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::techniques {
namespace {

/// A shadow map whose comparison ramps over a range of depth instead of stepping.
class Template : public shadow_maps::MapTechnique {};

}  // namespace

TechniqueDescription describe_template() {
  // GLSL reads this as parameter_ramp; validation, the JSON Schema and the web form follow from it.
  const Parameter ramp =
      real("ramp", 0.01, {0.0001, 1.0}, "Depth behind a caster over which its shadow darkens.")
          .log()
          .in("m");
  return {.label = "TPL",
          .title = "Shadow map with a depth ramp",
          .family = "map",
          .source = "none: an example",
          .parameters = shadow_maps::map_parameters() + std::vector{ramp},
          .diagnostics = {{"depth", "Distance from the light, as a share of the map's range."}},
          .create = create_technique<Template>};
}

}  // namespace penumbra::techniques
