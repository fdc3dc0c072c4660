#pragma once

#include <filesystem>
#include <string>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// The scene as a binary glTF 2.0 file with everything inside, so that others can render the same
/// thing: lights by KHR_lights_punctual, textures as PNG. What glTF has no words for (extents,
/// receivers, highlights, background) is in `extras.penumbra`; a scene that is read back from
/// it has the same content hash.
std::string encode_glb(const Scene& scene);

/// Writes encode_glb to a file. Throws bad_value (field "out") where it cannot.
void export_glb(const Scene& scene, const std::filesystem::path& file);

}  // namespace penumbra::scenes
