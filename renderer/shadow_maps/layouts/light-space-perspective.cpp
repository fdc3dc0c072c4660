#include <cmath>

#include "renderer/shadow_maps/views/light_view.h"
#include "renderer/shadow_maps/views/warp.h"

namespace penumbra::shadow_maps {
namespace {

/// Where errors near and far are alike (Wimmer, Scherzer and Purgathofer 2004, 5).
double best_distance(const WarpInput& input) {
  return (input.seen.near + std::sqrt(input.seen.near * input.seen.far)) / input.sine;
}

std::vector<shader::MapView> fit_light_space_perspective(const ViewFitting& fitting) {
  const double given = real_of(fitting.parameters, "warp_distance");
  return fit_warped(fitting, [given](const WarpInput& input) {
    return given > 0.0 ? given : best_distance(input);
  });
}

}  // namespace

Layout describe_light_space_perspective();
Layout describe_light_space_perspective() {
  const Parameter distance = real("warp_distance", 0.0, {0.0, 1e6},
                                  "From the warp's eye to the nearest place seen: the less, the "
                                  "more texels go to what is near. 0: the published optimum.")
                                 .in("m");
  return {.id = "light-space-perspective",
          .meaning = "one view bent so that near places get more texels, for directional lights",
          .parameters = {distance},
          .serves = {LightKind::directional},
          .view_count = [](const TechniqueInput&) { return 1u; },
          .fit = fit_light_space_perspective,
          .warps = always_warps};
}

}  // namespace penumbra::shadow_maps
