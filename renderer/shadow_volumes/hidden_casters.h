#pragma once

#include <set>

#include "renderer/frame/prepare_context.h"

namespace penumbra::shadow_volumes {

/// Instances that lie wholly in the shadow that another one throws from the light's centre:
/// whatever they shadow, that one does (Lloyd et al. 2004). Proved by boxes for what is hidden and
/// by triangles for what hides, so that some are missed and none is named wrongly. Only the casters
/// that look largest from the light are tried as what hides.
std::set<std::uint32_t> find_hidden_casters(const GpuScene& scene, const WorldLight& light);

}  // namespace penumbra::shadow_volumes
