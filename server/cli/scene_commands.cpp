#include <filesystem>

#include "renderer/error.h"
#include "scenes/export.h"
#include "scenes/library.h"
#include "server/cli/session.h"
#include "server/files/durable_file.h"
#include "server/http/scene_upload.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json summary(const Scene& scene) {
  std::uint64_t triangles = 0;
  for (const Instance& instance : scene.instances)
    triangles += scene.meshes.at(instance.mesh).indices.size() / 3;
  json names = json::array();
  for (const Light& light : scene.lights) names.push_back(light.name);
  json cameras = json::array();
  for (const Camera& camera : scene.cameras) cameras.push_back(camera.name);
  return {{"id", scene.id},      {"triangles", triangles}, {"instances", scene.instances.size()},
          {"lights", names},     {"cameras", cameras},     {"hash", scenes::content_hash(scene)},
          {"notes", scene.notes}};
}

std::string scene_text(const json& document) {
  std::string text = document.at("id").get<std::string>() + ": " + document.at("triangles").dump() +
                     " triangles in " + document.at("instances").dump() + " instances, " +
                     std::to_string(document.at("lights").size()) + " lights, " +
                     std::to_string(document.at("cameras").size()) + " cameras\n";
  for (const json& note : document.at("notes")) text += "note: " + note.get<std::string>() + "\n";
  return text;
}

int import_scene(const Session& session, const fs::path& file, const std::string& id,
                 const fs::path& data) {
  http::check_scene_id(id);
  for (const scenes::SceneInfo& info : scenes::built_in())
    if (info.id == id) throw bad_value("id", "--id " + id + " is the name of a built-in scene");
  // Kept as one file with everything in it, by the same way as uploads.
  const auto scene = scenes::load(fs::absolute(file).string());
  json document = http::store_scene(
      data, id, scenes::encode_glb(*scene),
      [](const fs::path& stored) { return summary(*scenes::load(stored.string())); });
  document.erase("replaced");
  document["id"] = id;
  document["notes"] = scene->notes;
  session.print(document, scene_text(document));
  return 0;
}

int export_scene(const Session& session, const std::string& name, const fs::path& out,
                 const fs::path& data) {
  if (out.extension() != ".glb")
    throw bad_value("out", "--out " + out.string() + ": the name must end in .glb");
  const auto scene = scenes::load(name, data);
  const fs::path temporary = out.string() + ".new";
  write_durably(out, temporary, scenes::encode_glb(*scene));
  json document = summary(*scene);
  document["out"] = out.string();
  session.print(document, scene_text(document) + "wrote " + out.string() + "\n");
  return 0;
}

struct SceneOptions {
  std::string scene;
  fs::path file;
  fs::path out;
  fs::path data = "data";
  std::string id;
};

}  // namespace

void add_scene_commands(CLI::App& app, Session& session) {
  auto options = std::make_shared<SceneOptions>();
  CLI::App* import =
      app.add_subcommand("import", "Take a scene from a glTF, GLB, OBJ or scene file");
  import->add_option("FILE", options->file, ".gltf, .glb, .obj, or a scene document .json")
      ->required()
      ->check(CLI::ExistingFile);
  import->add_option("--id", options->id, "What it will be called: a-z 0-9 - _")->required();
  import->add_option("--data", options->data, "Folder of imported scenes")->capture_default_str();
  add_json_flag(*import, session);
  import->callback([options, &session] {
    session.action = [options, &session] {
      return import_scene(session, options->file, options->id, options->data);
};
}  // namespace penumbra::server::cli
);

CLI::App* out = app.add_subcommand("export-scene", "Write a scene as binary glTF");
out->add_option("SCENE", options->scene, scenes::ways_to_name_a_scene())->required();
out->add_option("--out", options->out, "File, .glb")->required();
out->add_option("--data", options->data, "Folder of imported scenes")->capture_default_str();
add_json_flag(*out, session);
out->callback([options, &session] {
  session.action = [options, &session] {
    return export_scene(session, options->scene, options->out, options->data);
  };
});
}

}  // namespace penumbra::server::cli
