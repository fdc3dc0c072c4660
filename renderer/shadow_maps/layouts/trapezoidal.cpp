#include <limits>

#include "renderer/shadow_maps/views/light_view.h"
#include "renderer/shadow_maps/views/warp.h"

namespace penumbra::shadow_maps {
namespace {

/// The picture whose part `depth` of the length seen, from the near end on, covers `share` of the
/// map: the trapezoid around what is seen becomes a square (Martin and Tan 2004, 5). Where texels
/// are spread evenly that part covers more already, there is no such picture.
double trapezoid_distance(double length, double depth, double share) {
  const double line = 2.0 * share - 1.0;  // on a map from -1 to 1
  const double focus = depth * length;
  const double slack = length * (1.0 + line) - 2.0 * focus;
  if (slack <= 0.0) return std::numeric_limits<double>::infinity();
  return length * focus * (1.0 - line) / slack;
}

std::vector<shader::MapView> fit_trapezoidal(const ViewFitting& fitting) {
  const double depth = real_of(fitting.parameters, "focus_depth");
  const double share = real_of(fitting.parameters, "focus_share");
  return fit_warped(fitting, [=](const WarpInput& input) {
    return trapezoid_distance(input.length, depth, share);
  });
}

Parameter share_parameter(const char* name, double value, double maximum, const char* meaning) {
  return real(name, value, {0.01, maximum}, meaning);
}

}  // namespace

Layout describe_trapezoidal();
Layout describe_trapezoidal() {
  return {.id = "trapezoidal",
          .meaning = "one view of the trapezoid around what is seen, for directional lights",
          .parameters = {share_parameter("focus_depth", 0.3, 1.0,
                                         "Near part of the length seen that is in focus, across "
                                         "the light's direction."),
                         share_parameter("focus_share", 0.8, 0.99,
                                         "Share of the map that the part in focus gets.")},
          .serves = {LightKind::directional},
          .view_count = [](const TechniqueInput&) { return 1u; },
          .fit = fit_trapezoidal,
          .warps = always_warps};
}

}  // namespace penumbra::shadow_maps
