#pragma once

#include <cstdint>
#include <glm/glm.hpp>

/// Colour spaces of FLIP (Andersson et al. 2020, section 4.1), white point D65. Linear RGB is 0..1.
namespace penumbra::metrics {

/// Linear light 0..1 of an sRGB-encoded component (IEC 61966-2-1).
double linear_from_srgb(std::uint8_t encoded);
/// The same of a level with fractions, 0..255.
double linear_from_srgb(float level);

/// Opponent space that is linear in light: Y in -16..100, red-green Cx, blue-yellow Cz.
glm::dvec3 opponent_from_linear(const glm::dvec3& rgb);
glm::dvec3 linear_from_opponent(const glm::dvec3& opponent);

/// CIELAB with Hunt's adjustment: colourfulness fades with lightness.
glm::dvec3 hunt_lab_from_linear(const glm::dvec3& rgb);

/// Difference for large distances: city-block in lightness, Euclidean in a, b (Abasi et al. 2020).
double hyab_distance(const glm::dvec3& a, const glm::dvec3& b);

}  // namespace penumbra::metrics
