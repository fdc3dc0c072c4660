#include "renderer/render.h"
#include "scenes/document.h"
#include "scenes/json_reader.h"
#include "scenes/library.h"

namespace penumbra::scenes {
namespace {

using nlohmann::json;

/// Replaces keys of a light or a camera, whose name stays.
template <class Thing>
void override_keys(Thing& thing, const json& keys, const std::string& path,
                   void (*read)(const json&, const std::string&, Thing&)) {
  const std::string name = thing.name;
  try {
    read(keys, path, thing);
  } catch (const Error& error) {
    throw bad_value(error.field, error.what());
  }
  if (thing.name != name) throw bad_value(path + ".name", path + ".name must stay as it is");
}

/// Replaces keys of those of a scene's lights or cameras that `overrides` names; `list` is the
/// field that holds them.
template <class Thing>
Scene with_overrides(const Scene& scene, std::vector<Thing> Scene::*things, const char* list,
                     const char* one, const json& overrides,
                     void (*read)(const json&, const std::string&, Thing&)) {
  if (overrides.is_null()) return scene;
  if (!overrides.is_object())
    throw bad_value(list, std::string(list) + " must be an object: names to keys");
  Scene changed = scene;
  for (const auto& [name, keys] : overrides.items()) {
    Thing* thing = nullptr;
    std::string names;
    for (Thing& candidate : changed.*things) {
      if (candidate.name == name) thing = &candidate;
      names += (names.empty() ? "" : ", ") + candidate.name;
    }
    const std::string path = std::string(list) + "." + name;
    if (thing == nullptr)
      throw bad_value(path, std::string("no ") + one + " '" + name + "' in scene '" + scene.id +
                                "'; there are: " + (names.empty() ? "none" : names));
    override_keys(*thing, keys, path, read);
  }
  try {
    validate(changed);
  } catch (const Error& error) {
    throw bad_value(list, error.what());
  }
  return changed;
}

}  // namespace

Scene with_light_overrides(const Scene& scene, const json& overrides) {
  return with_overrides(scene, &Scene::lights, "lights", "light", overrides, read_light);
}

Scene with_camera_overrides(const Scene& scene, const json& overrides) {
  return with_overrides(scene, &Scene::cameras, "cameras", "camera", overrides, read_camera);
}

std::vector<Camera> camera_path(const Camera& base, const json& path) {
  if (!path.is_array()) throw bad_value("camera_path", "camera_path must be a list of cameras");
  if (path.size() > RenderLimits::max_camera_path)
    throw bad_value("camera_path", "camera_path must hold no more than " +
                                       std::to_string(RenderLimits::max_camera_path) + " cameras");
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string place = "camera_path[" + std::to_string(i) + "]";
    override_keys(cameras.emplace_back(base), path[i], place, read_camera);
  }
  return cameras;
}

json camera_path_document(const std::vector<Camera>& path) {
  json list = json::array();
  for (const Camera& camera : path) {
    list.push_back(write_camera(camera));
    list.back().erase("name");
  }
  return list;
}

}  // namespace penumbra::scenes
