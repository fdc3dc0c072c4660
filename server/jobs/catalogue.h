#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace penumbra {

struct Scene;

namespace server {

/// Body of GET /api/v1/scenes and of `penumbra scenes --json`:
/// {"scenes":[{"id","title","description","built_in"},..]}, built-in scenes first, then imported
/// ones by id.
nlohmann::json scene_catalogue(const std::filesystem::path& data);

/// What of a scene can be chosen for a picture: {"cameras": names, "lights": [{"name", "position"
/// or "direction"}], "diagonal"}; metres, the diagonal of the scene's box.
nlohmann::json scene_choices(const Scene& scene);

/// Body of GET /api/v1/techniques and of `penumbra techniques --json`:
/// {"techniques":[{"id","label","title","family","source","parameters": JSON Schema,
///    "diagnostics":[{"name","meaning"}]}],
///  "presets":[{"id","technique","label","title","source","parameters"}]}, techniques in order of
///  id.
nlohmann::json technique_catalogue();

}  // namespace server
}  // namespace penumbra
