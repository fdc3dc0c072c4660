#pragma once

#include <string>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// An occluder texture: black where the mesh covers the plane's rectangle, seen along its normal,
/// and white elsewhere. Mesh and plane lie in one space. `size` is its width and height in texels.
Texture silhouette_texture(const std::string& name, const Mesh& mesh, const ShadowPlane& plane,
                           std::uint32_t size);

/// The plane after a rigid motion.
ShadowPlane moved_plane(ShadowPlane plane, const glm::dmat4& motion);

}  // namespace penumbra::scenes
