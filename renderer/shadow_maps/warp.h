#pragma once

#include <functional>

#include "renderer/shadow_maps/seen.h"

/// Views of a directional light that are focused on what the camera sees, and bent so that what is
/// near the camera gets more texels.
namespace penumbra::shadow_maps {

/// What a warp may depend on.
struct WarpInput {
  Slice seen;     ///< along the camera's direction
  double length;  ///< m of what is seen along that direction, across the light's
  double sine;    ///< of the angle between the camera's direction and the light's
};

/// One view whose texels are spread as a perspective picture has them that is taken across the
/// light's direction, along the camera's, from as many metres before the nearest place seen as
/// `distance` returns. Infinite: evenly. A light is mapped along itself, so that casters keep the
/// place of what they shadow, wherever they stand. Evenly too where the camera is orthographic or
/// looks along the light.
std::vector<shader::MapView> fit_warped(const ViewFitting& fitting,
                                        const std::function<double(const WarpInput&)>& distance);

}  // namespace penumbra::shadow_maps
