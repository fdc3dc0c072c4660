#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "renderer/scene/light.h"

namespace penumbra {

/// Points on (sphere: in) the light's extent, uniform over its area, disc or ball: positions, or
/// unit directions towards a directional light. `count` points for each of `sets` samples of a
/// pixel, set after set; within a set, neighbours in order are neighbours in space, so that runs of
/// 32 are compact. Low-discrepancy: Sobol' points with Owen's scrambling from `seed`; the sets are
/// consecutive parts of one sequence. Random: independent, from a Mersenne twister.
/// With several `scrambles`, which divide `count`, a set consists of as many parts: point i belongs
/// to part i % scrambles, and neighbours in order are neighbours in space still. Parts are
/// scrambled independently where a pixel has least_independent points or more, so that their spread
/// tells the error. Fewer points would lose too much by that: they stay one sequence, of which the
/// parts are consecutive pieces, and the spread tells an upper estimate.
/// A `part` of the points of each set may be asked for alone; it begins and ends at multiples of
/// `scrambles`.
inline constexpr std::uint32_t least_independent = 256;
struct PointRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  friend bool operator==(const PointRange&, const PointRange&) = default;
};
std::vector<glm::vec4> light_points(const WorldLight& light, std::uint32_t count,
                                    std::uint32_t sets, std::uint64_t seed, bool random,
                                    std::uint32_t scrambles = 1,
                                    std::optional<PointRange> part = {});

}  // namespace penumbra
