#include "scenes/library.h"

#include "renderer/error.h"
#include "scenes/built_in/built_in.h"

namespace penumbra::scenes {

std::vector<SceneInfo> built_in() {
  std::vector<SceneInfo> list;
  for (const BuiltIn& entry : built_in_table())
    list.push_back({entry.id, entry.title, entry.description});
  return list;
}

std::shared_ptr<const Scene> load(const std::string& name, const std::filesystem::path& data) {
  (void)data;
  const auto finish = [](Scene scene) {
    validate(scene);
    return std::make_shared<const Scene>(std::move(scene));
  };
  if (name.rfind("sweep:", 0) == 0) return finish(make_sweep(name));
  std::string names;
  for (const BuiltIn& entry : built_in_table()) {
    if (name == entry.id) return finish(entry.make());
    names += std::string(names.empty() ? "" : ", ") + entry.id;
  }
  throw not_found("scene", "no scene '" + name + "'; there are: " + names + ", sweep:OxTxL");
}

}  // namespace penumbra::scenes
