#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::techniques {
namespace {

/// Hard shadows from one comparison with a linear depth map.
class ShadowMap : public shadow_maps::MapTechnique {};

}  // namespace

TechniqueDescription describe_shadow_map() {
  return {.label = "SSM",
          .title = "Shadow map",
          .family = "map",
          .source = "van Sambeek 2007, 2.2.1-2.2.3 and 3.2.4; Williams 1978",
          .parameters = shadow_maps::comparing_map_parameters(),
          .diagnostics = shadow_maps::map_diagnostics(),
          .create = create_technique<ShadowMap>};
}

}  // namespace penumbra::techniques
