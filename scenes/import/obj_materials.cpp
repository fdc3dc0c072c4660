#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "renderer/error.h"
#include "scenes/import/obj.h"
#include "scenes/text.h"

namespace penumbra::scenes::obj {
namespace {

/// Statements of a material file whose words are numbers.
const std::set<std::string_view> numeric = {"Ka", "Kd", "Ks", "Ke", "Tf", "Kt",   "Ns",
                                            "Ni", "d",  "Tr", "Pr", "Pm", "illum"};

/// A statement as the library reads it: one line, points in numbers. Throws unreadable for numbers
/// that are not finite.
std::string plain_line(const std::vector<std::string_view>& words, std::size_t line) {
  if (numeric.count(words[0]) == 0) return rest_of(words, 0);
  std::string text(words[0]);
  for (std::size_t i = 1; i < words.size(); ++i) {
    std::string word(words[i]);
    const auto first = static_cast<unsigned char>(word.front());
    const bool option = word.front() == '-' && word.size() > 1 && std::isalpha(word[1]) != 0;
    // Others are words of their own: "Kd spectral", "d -halo".
    if (word == "nan" || word == "inf" || std::isdigit(first) != 0 || first == '.' ||
        (!option && (first == '-' || first == '+'))) {
      std::ostringstream number;
      number.precision(9);
      number << number_of(words[i], line);
      word = number.str();
    }
    text += " " + word;
  }
  return text;
}

struct Library {
  std::map<std::string, int> index_of;
  std::vector<tinyobj::material_t> materials;
};

void read_library(const std::string& name, SideFiles& files, Library& library, Notes& notes) {
  const auto bytes = files.read(name, "mtllib");
  if (!bytes) return;
  std::string text;
  try {
    for_each_statement(*bytes, [&](const std::vector<std::string_view>& words, std::size_t line) {
      text += plain_line(words, line) + "\n";
    });
  } catch (const Error& error) {
    notes.add("mtllib " + in_quotes(name), std::string(": ") + error.what() + ": it is left out");
    return;
  }
  std::istringstream stream(text);
  std::string warnings, errors;
  tinyobj::LoadMtl(&library.index_of, &library.materials, &stream, &warnings, &errors);
}

float share(double value) {
  return std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : 0.0f;
}

Material material_of(const tinyobj::material_t& from, int texture, const std::string& where,
                     Notes& notes) {
  Material material;
  material.name = from.name;
  material.texture = texture;
  for (int c = 0; c < 3; ++c) {
    material.base_color[c] = share(static_cast<double>(from.diffuse[c]));
    material.emissive[c] = share(static_cast<double>(from.emission[c]));
  }
  // Many exporters write black beside a texture that is meant to be seen.
  if (texture >= 0 && material.base_color == glm::vec3(0.0f)) material.base_color = glm::vec3(1.0f);
  material.specular = 0.5f * share(static_cast<double>(from.specular[0]));
  const double shininess = static_cast<double>(from.shininess);
  material.shininess =
      std::isfinite(shininess) ? static_cast<float>(std::clamp(shininess, 1.0, 256.0)) : 1.0f;
  material.double_sided = true;
  if (!from.alpha_texname.empty()) {
    if (texture >= 0 && from.alpha_texname == from.diffuse_texname)
      material.alpha_mode = AlphaMode::mask;
    else
      notes.add(where, ": its map_d is left out");
  }
  if (from.dissolve < 1.0f) notes.add(where, " is transparent in the file and solid here");
  for (const std::string* name : {&from.bump_texname, &from.normal_texname})
    if (!name->empty()) notes.add(where, ": its bump or normal map is left out");
  if (!from.emissive_texname.empty()) notes.add(where, ": its emissive map is left out");
  if (from.diffuse_texopt.clamp) notes.add(where, ": its texture repeats instead of clamping");
  return material;
}

class Materials {
 public:
  Materials(SideFiles& files_, Scene& scene_, Notes& notes_)
      : files(files_), scene(scene_), notes(notes_), store(scene_, notes_, max_texture_bytes) {}

  void add(const tinyobj::material_t& from) {
    const std::string where = "material " + in_quotes(from.name);
    scene.materials.push_back(
        material_of(from, texture_of(from.diffuse_texname, where), where, notes));
  }

 private:
  int texture_of(const std::string& name, const std::string& where) {
    if (name.empty()) return -1;
    const auto [entry, added] = known.try_emplace(name, -1);
    if (!added) return entry->second;
    if (const auto bytes = files.read(name, where + ": map_Kd"))
      entry->second = store.add(name, *bytes, where + ": map_Kd " + in_quotes(name));
    return entry->second;
  }

  SideFiles& files;
  Scene& scene;
  Notes& notes;
  TextureStore store;
  std::map<std::string, int> known;
};

Material grey(const std::string& name) {
  Material material;
  material.name = name;
  material.double_sided = true;
  return material;
}

}  // namespace

void read_materials(const File& file, SideFiles& files, Scene& scene, Notes& notes) {
  Library library;
  std::set<std::string> read;
  for (const std::string& line : file.material_libraries) {
    // A line may have several names, and a name may have spaces.
    std::istringstream words(line);
    std::vector<std::string> names{line};
    if (line.find(' ') != std::string::npos && !files.has(line))
      names.assign(std::istream_iterator<std::string>(words), {});
    for (const std::string& name : names)
      if (read.insert(name).second) read_library(name, files, library, notes);
  }
  Materials materials(files, scene, notes);
  for (const std::string& name : file.material_names) {
    const auto found = library.index_of.find(name);
    if (found != library.index_of.end()) {
      materials.add(library.materials[static_cast<std::size_t>(found->second)]);
      continue;
    }
    notes.add("material " + in_quotes(name), " is in no material file: it is grey");
    scene.materials.push_back(grey(name));
  }
  scene.materials.push_back(grey("default"));
}

}  // namespace penumbra::scenes::obj
