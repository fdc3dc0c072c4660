#pragma once

#include <cstddef>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// What an imported scene is made of, without strays: vertices that lie beyond a wide gap around
/// the most of them.
struct Model {
  Bounds bounds;
  std::size_t strays = 0;  ///< vertices left out of the bounds
  bool has_floor = false;  ///< facets at the bottom that look up lie under the most of the rest
};

Model measure_model(const Scene& scene);

}  // namespace penumbra::scenes
