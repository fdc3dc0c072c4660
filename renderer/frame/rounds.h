#pragma once

#include <vector>

#include "renderer/scene/light_points.h"

namespace penumbra {

/// Most light points per pixel drawn in one round when no error bound is set.
inline constexpr std::uint32_t most_round_points = 4096;

/// Parts of a pixel's `light_samples` points that are drawn one after the other. `bounded`: from
/// least_independent points on each doubles their number, so that a picture which may stop has
/// drawn at most twice what it needed, and points are complete nets whenever it looks.
std::vector<PointRange> rounds_of(std::uint32_t light_samples, bool bounded);

}  // namespace penumbra
