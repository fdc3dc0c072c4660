#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/scene/scene.h"
#include "scenes/import/side_files.h"

namespace penumbra::scenes {

/// Scene documents: schema/scene.schema.json, docs/scenes.md.

/// Parses JSON text of at most 64 levels. Throws unreadable naming `name` and the place.
nlohmann::json parse_json(const std::string& text, const std::string& name);

/// The scene a document describes; files it names are looked up in `folder` and nowhere above it
/// (an empty folder: it may name none). Throws unreadable naming the path in the document, also of
/// the first texture with which they take more than `most_texture_bytes` decoded.
Scene read_document(const nlohmann::json& document, const std::filesystem::path& folder,
                    std::uint64_t most_texture_bytes = max_texture_bytes);

/// Complete document of a scene: read back it has the same content hash. Textures are kept as PNG.
nlohmann::json write_document(const Scene& scene);

/// Parts that other formats carry too (extras.penumbra of glTF). `path` names the place in
/// messages.
nlohmann::json write_light(const Light& light);
nlohmann::json write_camera(const Camera& camera);
nlohmann::json write_surroundings(
    const Scene& scene);  ///< receivers, ambient, background, exposure
nlohmann::json write_material(const Material& material);

/// Replace what the keys of the value say; keys that it lacks stay as they are.
void read_light(const nlohmann::json& value, const std::string& path, Light& light);
void read_camera(const nlohmann::json& value, const std::string& path, Camera& camera);
void read_surroundings(const nlohmann::json& value, const std::string& path, Scene& scene);
/// Takes the number of the texture in the value for the index.
void read_material(const nlohmann::json& value, const std::string& path, Material& material);

}  // namespace penumbra::scenes
