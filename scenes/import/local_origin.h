#pragma once

#include <glm/glm.hpp>
#include <span>

namespace penumbra::scenes {

/// The place that a mesh's coordinates are best counted from where they are to fit into floats:
/// zero for a mesh near the origin; a place near most of its points where they are far from it, as
/// in georeferenced files. A few stray points have no say. Meshes that touch share one, unless
/// they differ much in size.
glm::dvec3 local_origin(std::span<const glm::dvec3> points);

}  // namespace penumbra::scenes
