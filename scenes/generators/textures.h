#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// Names of the textures below, in a stable order.
const std::vector<std::string>& texture_generators();

/// Tileable picture of a surface: a pure function of its arguments, equal on every machine. `size`
/// is its width and height in texels. How many metres one repeat covers is the user's choice; what
/// suits is said in docs/scenes.md. Throws bad_value for an unknown generator or a size outside
/// 1..4096.
Texture generate_texture(const std::string& generator, std::uint32_t size, std::uint32_t seed);

}  // namespace penumbra::scenes
