#pragma once

#include "renderer/shadow_maps/layout.h"

/// Where tiles stand, and the ranges that they have before it is known what is seen.
namespace penumbra::shadow_maps {

/// Parameters of layouts of tiles: importance_range, importance_gain, tile_radius, tile_range,
/// tile_sizes, tile_culling.
std::vector<Parameter> tile_parameters();

/// Whether the range of each tile is that of what is seen in it. Penumbrae follow blockers, which
/// clamping onto such a range loses.
bool ranges_follow_samples(const ParameterValues& parameters, const MapUse& use);

/// The tiles row by row, right and down in the light's fixed axes, without sizes.
std::vector<shader::MapView> place_tiles(const ViewFitting& fitting);

}  // namespace penumbra::shadow_maps
