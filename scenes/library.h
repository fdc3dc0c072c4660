#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

struct SceneInfo {
  std::string id;
  std::string title;
  std::string description;
};

/// Built-in scenes, survey scenes first, in a stable order.
std::vector<SceneInfo> built_in();

/// Names of scenes that are made from numbers, for messages and help: "sweep:OxTxL, fleet:N".
std::string generated_forms();
/// The same with what the numbers count.
std::string generated_forms_explained();

/// What may be given for a scene, for the help of commands.
std::string ways_to_name_a_scene();

/// Whether a name is that of a built-in scene or of one made from numbers.
bool is_generated(const std::string& name);

/// Loads SCENE as the contract has it: a built-in id, an imported id (data/scenes/<id>), a path to
/// a scene JSON, glTF, GLB or OBJ file, or a name made from numbers (`sweep:OxTxL`, `fleet:N`).
/// `data` may be empty (no imported scenes). Throws not_found (field "scene", listing the ids there
/// are) or unreadable naming file and element.
std::shared_ptr<const Scene> load(const std::string& name, const std::filesystem::path& data = {});

/// The files in a folder and below that its scene may be read from: those least deep, scene
/// documents only where there is no model; sorted. The first is the scene's.
std::vector<std::filesystem::path> scene_files(const std::filesystem::path& folder);

/// Hash of everything in the scene that can change a picture, 32 hexadecimal digits: equal scenes
/// have equal hashes however they were loaded.
std::string content_hash(const Scene& scene);

/// Copy of the scene with light keys replaced: {"NAME": {"position": [x,y,z], "intensity": 2,
/// "extent": {...}}, ...}, the keys of a light in the scene document. Throws bad_value naming the
/// field (lights.NAME.key).
Scene with_light_overrides(const Scene& scene, const nlohmann::json& overrides);
/// The same for cameras: {"NAME": {"position": [x,y,z], "field_of_view": 40}, ...}.
Scene with_camera_overrides(const Scene& scene, const nlohmann::json& overrides);

/// The cameras of a path: each is `base` with the keys replaced that its element of the list has.
/// Throws bad_value naming the field (camera_path[3].position).
std::vector<Camera> camera_path(const Camera& base, const nlohmann::json& path);
/// The same path with nothing left open.
nlohmann::json camera_path_document(const std::vector<Camera>& path);

}  // namespace penumbra::scenes
