#include "scenes/library.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "renderer/error.h"
#include "scenes/built_in/built_in.h"
#include "scenes/document.h"
#include "scenes/import/import.h"
#include "scenes/text.h"

namespace penumbra::scenes {
namespace fs = std::filesystem;
namespace {

bool is_scene_file(const fs::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".gltf" || extension == ".glb" || extension == ".obj" || extension == ".json";
}

/// A message about a file is at most so long, bytes: it may quote what the file says.
constexpr std::size_t longest_message = 500;

/// A scene that was kept brings its notes along.
void add_once(std::vector<std::string>& notes, const std::string& note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

/// Every text that a file brought as UTF-8.
void repair_texts(Scene& scene) {
  for (std::string* text : {&scene.id, &scene.title}) *text = valid_text(*text);
  const auto repair = [](auto& list) {
    for (auto& element : list) element.name = valid_text(element.name);
  };
  repair(scene.textures);
  repair(scene.materials);
  repair(scene.meshes);
  repair(scene.instances);
  repair(scene.lights);
  repair(scene.cameras);
  repair(scene.receivers);
  repair(scene.shadow_planes);
  for (ShadowPlane& plane : scene.shadow_planes) {
    plane.texture = valid_text(plane.texture);
    for (std::string& caster : plane.casters) caster = valid_text(caster);
  }
  // By here both JSON and OBJ have had their broken bytes replaced.
  const auto broken = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& element) {
      return element.name.find("\xef\xbf\xbd") != std::string::npos;
    });
  };
  if (broken(scene.textures) || broken(scene.materials) || broken(scene.meshes) ||
      broken(scene.instances) || broken(scene.lights) || broken(scene.cameras))
    add_once(scene.notes, "names have bytes that are no UTF-8: they were replaced");
  for (std::string& note : scene.notes) note = shortened(note, longest_message);
}

/// Leaves meshes without triangles out, and what would draw them.
void drop_empty_meshes(Scene& scene) {
  std::vector<std::uint32_t> number_of;
  std::vector<Mesh> kept;
  for (Mesh& mesh : scene.meshes) {
    number_of.push_back(static_cast<std::uint32_t>(kept.size()));
    if (!mesh.indices.empty())
      kept.push_back(std::move(mesh));
    else
      number_of.back() = 0xffffffffu;
  }
  if (kept.size() == scene.meshes.size()) {
    scene.meshes = std::move(kept);
    return;
  }
  scene.meshes = std::move(kept);
  const auto none = [&](const Instance& instance) {
    return instance.mesh < number_of.size() && number_of[instance.mesh] == 0xffffffffu;
  };
  std::erase_if(scene.instances, none);
  for (Instance& instance : scene.instances)
    if (instance.mesh < number_of.size()) instance.mesh = number_of[instance.mesh];
}

/// The one function that reads scenes from files.
Scene load_file(const fs::path& file) {
  const std::string extension = lower_extension(file);
  try {
    Scene scene;
    if (extension == ".json")
      scene = read_document(parse_json(read_bytes(file), "the scene document"),
                            file.has_parent_path() ? file.parent_path() : fs::path("."));
    else
      scene = extension == ".obj" ? import_obj(file) : import_gltf(file);
    repair_texts(scene);
    drop_empty_meshes(scene);
    validate(scene);
    return scene;
  } catch (const Error& error) {
    // The file's name alone: where it lies must not be told over HTTP.
    throw Error(
        error.code,
        valid_text(file.filename().string()) + ": " + shortened(error.what(), longest_message),
        shortened(error.field, longest_message));
  } catch (const std::bad_alloc&) {
    throw unreadable(valid_text(file.filename().string()) + ": needs more memory than there is");
  }
}

/// An imported id is one path component of letters, digits, - and _.
bool is_id(const std::string& name) {
  return !name.empty() && name.size() <= 64 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

/// Main file of an imported scene: data/scenes/ID.EXT, or the one scene file in data/scenes/ID/.
fs::path imported_file(const std::string& id, const fs::path& data) {
  std::error_code ignored;
  for (const char* extension : {".glb", ".gltf", ".json", ".obj"})
    if (const fs::path file = data / "scenes" / (id + extension);
        fs::is_regular_file(file, ignored))
      return file;
  const fs::path folder = data / "scenes" / id;
  const std::vector<fs::path> found = scene_files(folder);
  return found.empty() ? fs::path() : found.front();
}

std::string known_names(const fs::path& data) {
  std::string names;
  for (const BuiltIn& entry : built_in_table()) names += std::string(entry.id) + ", ";
  std::error_code ignored;
  std::vector<std::string> imported;
  if (!data.empty() && fs::is_directory(data / "scenes", ignored))
    for (const fs::directory_entry& entry : fs::directory_iterator(data / "scenes"))
      imported.push_back(entry.path().stem().string());
  std::sort(imported.begin(), imported.end());
  for (const std::string& id : imported)
    if (is_id(id)) names += id + ", ";
  return names + generated_forms() + ", or the path of a .json, .gltf, .glb or .obj file";
}

}  // namespace

std::vector<fs::path> scene_files(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> found;
  if (!fs::is_directory(folder, ignored)) return found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file(ignored) && is_scene_file(entry.path()))
      found.push_back(entry.path());
  const auto rank = [](const fs::path& file) {
    return 10 * std::distance(file.begin(), file.end()) +
           (lower_extension(file) == ".json" ? 1 : 0);
  };
  std::sort(found.begin(), found.end(), [&](const fs::path& a, const fs::path& b) {
    return std::pair(rank(a), a) < std::pair(rank(b), b);
  });
  std::erase_if(found, [&, best = found.empty() ? 0 : rank(found.front())](const fs::path& file) {
    return rank(file) != best;
  });
  return found;
}

std::vector<SceneInfo> built_in() {
  std::vector<SceneInfo> list;
  for (const BuiltIn& entry : built_in_table())
    list.push_back({entry.id, entry.title, entry.description});
  return list;
}

std::string generated_forms() {
  std::string forms;
  for (const SceneFamily& family : scene_families())
    forms += (forms.empty() ? "" : ", ") + std::string(family.form);
  return forms;
}

std::string generated_forms_explained() {
  std::string text;
  for (const SceneFamily& family : scene_families())
    text += (text.empty() ? "" : "; ") + std::string(family.form) + " is " + family.contents;
  return text;
}

std::string ways_to_name_a_scene() {
  return "Built-in or imported id, " + generated_forms() + ", or a file";
}

bool is_generated(const std::string& name) {
  const auto starts = [&](const SceneFamily& family) { return name.starts_with(family.prefix); };
  const auto is_named = [&](const BuiltIn& entry) { return name == entry.id; };
  return std::any_of(scene_families().begin(), scene_families().end(), starts) ||
         std::any_of(built_in_table().begin(), built_in_table().end(), is_named);
}

std::shared_ptr<const Scene> load(const std::string& name, const fs::path& data) {
  const auto finish = [](Scene scene) {
    validate(scene);
    return std::make_shared<const Scene>(std::move(scene));
  };
  for (const SceneFamily& family : scene_families())
    if (name.starts_with(family.prefix)) return finish(family.make(name));
  for (const BuiltIn& entry : built_in_table())
    if (name == entry.id) return finish(entry.make());
  if (!data.empty() && is_id(name)) {
    if (const fs::path file = imported_file(name, data); !file.empty()) {
      Scene scene = load_file(file);
      scene.id = name;
      return std::make_shared<const Scene>(std::move(scene));
    }
  }
  std::error_code ignored;
  if (name.find('\0') == std::string::npos && is_scene_file(name) &&
      fs::is_regular_file(name, ignored))
    return std::make_shared<const Scene>(load_file(name));
  throw not_found("scene", "no scene " + in_quotes(name) + "; there are: " + known_names(data));
}

}  // namespace penumbra::scenes
