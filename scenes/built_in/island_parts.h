#pragma once

#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {

/// Looks and meshes of what stands on the island.
Mesh make_palm(const Look& bark, const Look& leaf, const Look& nut, std::uint32_t seed);
Mesh make_hut(const Look& planks, const Look& thatch);
Mesh make_jetty(const Look& planks);
Mesh make_boat(const Look& hull, const Look& inside);

}  // namespace penumbra::scenes
