#include "server/jobs/catalogue.h"

#include "renderer/scene/light.h"
#include "renderer/technique.h"
#include "scenes/library.h"
#include "server/jobs/request_scene.h"
#include "techniques/parameter_schema.h"
#include "techniques/registry.h"

namespace penumbra::server {
using nlohmann::json;

json scene_catalogue(const std::filesystem::path& data) {
  json list = json::array();
  for (const scenes::SceneInfo& info : scenes::built_in())
    list.push_back({{"id", info.id},
                    {"title", info.title},
                    {"description", info.description},
                    {"built_in", true}});
  for (const std::string& id : imported_scenes(data)) {
    const json about = about_imported_scene(data, id);
    list.push_back({{"id", id},
                    {"title", about.at("title")},
                    {"description", "imported"},
                    {"built_in", false},
                    {"notes", about.at("notes")}});
  }
  return {{"scenes", list}};
}

json scene_choices(const Scene& scene) {
  const auto vector = [](const glm::dvec3& v) { return json{v.x, v.y, v.z}; };
  json cameras = json::array();
  for (const Camera& camera : scene.cameras) cameras.push_back(camera.name);
  json lights = json::array();
  for (const Light& light : scene.lights) {
    if (is_at_infinity(light))
      lights.push_back({{"name", light.name}, {"direction", vector(light.direction)}});
    else
      lights.push_back({{"name", light.name}, {"position", vector(light.position)}});
  }
  return {{"cameras", cameras},
          {"lights", lights},
          {"diagonal", glm::length(world_bounds(scene).size())}};
}

json technique_catalogue() {
  json list = json::array();
  for (const TechniqueDescription& technique : techniques::all()) {
    json diagnostics = json::array();
    for (const Diagnostic& diagnostic : technique.diagnostics)
      diagnostics.push_back({{"name", diagnostic.name}, {"meaning", diagnostic.meaning}});
    list.push_back({{"id", technique.id},
                    {"label", technique.label},
                    {"title", technique.title},
                    {"family", technique.family},
                    {"source", technique.source},
                    {"parameters", techniques::parameter_schema(technique.parameters)},
                    {"diagnostics", diagnostics}});
  }
  json presets = json::array();
  for (const techniques::Preset& preset : techniques::presets())
    presets.push_back({{"id", preset.id},
                       {"technique", preset.technique},
                       {"label", preset.label},
                       {"title", preset.title},
                       {"source", preset.source},
                       {"parameters", techniques::values_to_json(preset.parameters)}});
  return {{"techniques", list}, {"presets", presets}};
}

}  // namespace penumbra::server
