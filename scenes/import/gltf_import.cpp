#include "renderer/error.h"
#include "scenes/document.h"
#include "scenes/import/gltf.h"
#include "scenes/json_reader.h"

namespace penumbra::scenes {
namespace gltf {

void read_extras(const nlohmann::json& document, Scene& scene) {
  const nlohmann::json& extras = document["asset"]["extras"]["penumbra"];
  const std::string path = "asset.extras.penumbra";
  JsonReader reader(extras, path);
  std::int64_t version = 0;
  reader.integer("version", version, 1, 1);
  reader.text("id", scene.id);
  reader.text("title", scene.title);
  const auto list = [&](const char* key) -> const nlohmann::json& {
    const nlohmann::json& value = reader.at(key);
    if (!value.is_array()) reader.fail(key, "must be a list");
    return value;
  };
  scene.lights.clear();
  scene.cameras.clear();
  scene.materials.clear();
  const nlohmann::json& lights = list("lights");
  for (std::size_t i = 0; i < lights.size(); ++i)
    read_light(lights[i], element((path + ".lights").c_str(), i), scene.lights.emplace_back());
  const nlohmann::json& cameras = list("cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i)
    read_camera(cameras[i], element((path + ".cameras").c_str(), i), scene.cameras.emplace_back());
  const nlohmann::json& materials = list("materials");
  for (std::size_t i = 0; i < materials.size(); ++i)
    read_material(materials[i], element((path + ".materials").c_str(), i),
                  scene.materials.emplace_back());
  read_surroundings(reader.at("surroundings"), reader.path_of("surroundings"), scene);
  const nlohmann::json& casters = list("casts_shadow");
  if (casters.size() != scene.instances.size())
    reader.fail("casts_shadow", "must have one entry per instance");
  for (std::size_t i = 0; i < casters.size(); ++i) {
    if (!casters[i].is_boolean()) reader.fail("casts_shadow", "must hold true and false");
    scene.instances[i].casts_shadow = casters[i].get<bool>();
  }
  // What was left out when the scene came in.
  if (reader.has("notes")) {
    for (const nlohmann::json& note : list("notes")) {
      if (!note.is_string()) reader.fail("notes", "must hold texts");
      scene.notes.push_back(note);
    }
  }
  reader.finish();
}

/// Whether the file is one of ours, whose extras say everything about lights and cameras.
bool has_extras(const nlohmann::json& document) {
  const auto asset = document.find("asset");
  return asset != document.end() && asset->contains("extras") && (*asset)["extras"].is_object() &&
         (*asset)["extras"].contains("penumbra");
}

}  // namespace gltf

Scene import_gltf(const std::filesystem::path& file, bool complete) {
  nlohmann::json document;
  Notes notes;
  const tinygltf::Model model = gltf::parse(file, document, notes);
  const bool ours = gltf::has_extras(document);
  Scene scene;
  scene.id = scene.title = file.stem().string();
  const std::vector<gltf::TextureUse> uses = gltf::read_materials(model, ours, scene, notes);
  gltf::read_meshes(model, uses, scene, notes);
  gltf::read_nodes(model, scene, notes);
  if (scene.instances.empty()) throw unreadable("the file has no triangles to draw");
  if (ours) gltf::read_extras(document, scene);
  notes.write_to(scene.notes);
  if (!ours && complete) {
    const bool lit = !scene.lights.empty();
    complete_import(scene);
    if (lit) gltf::expose(scene);
  }
  return scene;
}

}  // namespace penumbra::scenes
