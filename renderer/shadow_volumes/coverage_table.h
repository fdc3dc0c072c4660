#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/scene/light.h"

namespace penumbra::shadow_volumes {

/// Part of the light's area that lies beyond a piece of a straight line, as seen from the centre:
/// between the ray to the foot of the line (its point nearest to the centre) and the ray at `angle`
/// from it, on the far side of the line. `distance` of the line from the centre in half sizes;
/// `direction` of the foot in radians; `angle` from -pi/2 to pi/2. Odd in angle for round lights.
double part_beyond_line(LightShape shape, double direction, double distance, double angle);

/// part_beyond_line over a grid, for renderer/shadow_volumes/coverage_table.glsl.
struct CoverageTable {
  std::uint32_t size = 0;        ///< places along distance and angle
  std::uint32_t directions = 1;  ///< places over a quarter turn, both ends included; 1 if round
  float range = 1.0f;            ///< greatest distance; at it nothing lies beyond
  std::vector<float> values;     ///< [direction][distance][angle]
};

/// Points spread as the light is, by a golden-section lattice.
std::vector<glm::dvec2> light_lattice(LightShape shape, std::uint32_t count);

/// `size` of at least 2.
CoverageTable make_coverage_table(LightShape shape, std::uint32_t size);

}  // namespace penumbra::shadow_volumes
