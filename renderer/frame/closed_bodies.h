#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace penumbra {

/// By triangle: whether it belongs to a body whose surface has no edge and is wound outwards, so
/// that from outside no ray meets it from behind before it met it from the front. `corners` name
/// one vertex for each place, three a triangle. Bodies hang together along sides. A skin that
/// passes through itself is not found out.
std::vector<bool> in_closed_bodies(std::span<const glm::vec3> positions,
                                   std::span<const std::uint32_t> corners);

}  // namespace penumbra
