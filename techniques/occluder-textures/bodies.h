#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <set>
#include <vector>

#include "renderer/scene/gpu_scene.h"

namespace penumbra::techniques::occluder_textures {

using Triangle = std::array<glm::dvec3, 3>;

/// Triangles of an instance that hang together by corners of equal position. World space.
struct Body {
  std::uint32_t instance = 0;
  std::vector<Triangle> triangles;
};

/// Bodies of the casters among these instances, instance by instance.
std::vector<Body> find_bodies(const GpuScene& scene, const std::set<std::uint32_t>& instances);

/// Where a body lies along three axes.
struct OrientedBox {
  glm::dmat3 axes{1.0};  ///< unit columns, right-handed
  glm::dvec3 center{0.0};
  glm::dvec3 half{0.0};  ///< along the axes
};

/// Around the body, along the given axes or, where that makes it thinner, along the principal axes
/// of its surface: a fin that is set at an angle is as flat as one that is not.
OrientedBox box_around(const Body& body, const glm::dmat3& axes);

}  // namespace penumbra::techniques::occluder_textures
