#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <set>
#include <vector>

#include "renderer/frame/gpu_scene.h"

namespace penumbra::techniques::occluder_textures {

using Triangle = std::array<glm::dvec3, 3>;

/// Triangles of an instance that hang together by corners of equal position, or a part of them.
/// World space.
struct Body {
  std::uint32_t instance = 0;
  std::vector<Triangle> triangles;
  bool sheet = false;       ///< a flat part that encloses nothing: no plane has a section of it
  std::uint32_t whole = 0;  ///< of in_flat_parts: parts of one body have the same
};

/// Bodies of the casters among these instances, instance by instance.
std::vector<Body> find_bodies(const GpuScene& scene, const std::set<std::uint32_t>& instances);

struct FlatParts {
  std::vector<Body> bodies;
  std::size_t open = 0;  ///< bodies that enclose nothing but have too many parts: left whole
};

/// The same bodies, but those that enclose no space taken apart: a sheet has no inside that a plane
/// could cut, but a flat part of it is its own silhouette. Parts leave their plane by no more than
/// 1 % of the body's size. Bodies of more than `most` parts are left whole.
FlatParts in_flat_parts(std::vector<Body> bodies, std::size_t most);

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
