#include "scenes/document.h"
#include "scenes/json_reader.h"
#include "scenes/library.h"

namespace penumbra::scenes {

Scene with_light_overrides(const Scene& scene, const nlohmann::json& overrides) {
  if (overrides.is_null()) return scene;
  if (!overrides.is_object()) throw bad_value("lights", "lights must be an object: names to keys");
  Scene changed = scene;
  for (const auto& [name, keys] : overrides.items()) {
    Light* light = nullptr;
    std::string names;
    for (Light& candidate : changed.lights) {
      if (candidate.name == name) light = &candidate;
      names += (names.empty() ? "" : ", ") + candidate.name;
    }
    const std::string path = "lights." + name;
    if (light == nullptr)
      throw bad_value(path, "no light '" + name + "' in scene '" + scene.id +
                                "'; there are: " + (names.empty() ? "none" : names));
    try {
      read_light(keys, path, *light);
    } catch (const Error& error) {
      throw bad_value(error.field, error.what());
    }
    if (light->name != name) throw bad_value(path + ".name", path + ".name must stay as it is");
  }
  try {
    validate(changed);
  } catch (const Error& error) {
    throw bad_value("lights", error.what());
  }
  return changed;
}

}  // namespace penumbra::scenes
