#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "renderer/scene/scene.h"
#include "renderer/shaders/shader_types.h"

namespace penumbra {

/// A light in the renderer's world space.
struct WorldLight {
  LightKind kind = LightKind::spot;
  glm::dvec3 position{0.0};
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< unit, into the scene
  glm::dvec3 right{1.0, 0.0, 0.0};       ///< unit, along a rectangle's width
  glm::dvec3 up{0.0, 0.0, 1.0};          ///< unit, along its height
  const Light* source = nullptr;
};

WorldLight world_light(const Light& light, const glm::dvec3& origin);

/// As shaders see it; `points` in the batch and `weight` of the batch are the caller's.
shader::LightData light_data(const WorldLight& light, float points, float weight);

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

/// Corners of a box around the extent in the light's own axes: half sizes along right, up,
/// direction; metres, or tangents of the angle for a directional light.
glm::dvec3 extent_half_size(const Light& light);

/// Radius of the sphere around the extent's centre that holds all of it, likewise.
double extent_radius(const Light& light);

}  // namespace penumbra
