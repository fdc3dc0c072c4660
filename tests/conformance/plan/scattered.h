#pragma once

#include "renderer/scene/scene.h"

namespace penumbra::test {

/// A ground slab, boxes strewn all around the camera and above it, each of its own colour, and
/// three lights: a spot light on what is seen, a sun, and a spot light whose place the seed
/// chooses. Nothing is aimed: some boxes are out of sight, some out of every light, some in the
/// way.
Scene scattered(std::uint32_t seed);

}  // namespace penumbra::test
