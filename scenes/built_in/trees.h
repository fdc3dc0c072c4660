#pragma once

#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {

/// Broad-leaved tree, about 6 m high, its trunk's foot at y = 0.
Mesh make_tree(const Look& bark, const Look& leaves, std::uint32_t seed);

}  // namespace penumbra::scenes
