#pragma once

#include <vector>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// A point of a surface in the scene's coordinates, with the facet's unit normal towards the
/// camera.
struct SeenPoint {
  glm::dvec3 position;
  glm::dvec3 normal;
};

/// The nearest surfaces along rays through the middles of `side` x `side` cells of a square
/// picture, row by row; cells that show the background are left out. Single-sided facets that are
/// turned away, and what alpha cuts away as a whole, are looked through.
std::vector<SeenPoint> seen_points(const Scene& scene, const Camera& camera, int side);

}  // namespace penumbra::scenes
