#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace penumbra::server {

/// Body of GET /api/v1/scenes and of `penumbra scenes --json`:
/// {"scenes":[{"id","title","description","built_in"},..]}, built-in scenes first, then imported
/// ones by id.
nlohmann::json scene_catalogue(const std::filesystem::path& data);

/// Body of GET /api/v1/techniques and of `penumbra techniques --json`:
/// {"techniques":[{"id","label","title","family","source","parameters": JSON Schema,
///    "diagnostics":[{"name","meaning"}]}],
///  "presets":[{"id","technique","label","title","source","parameters"}]}, techniques in order of
///  id.
nlohmann::json technique_catalogue();

}  // namespace penumbra::server
