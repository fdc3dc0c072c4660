#include <cstring>
#include <set>

#include "renderer/error.h"
#include "scenes/document.h"
#include "scenes/import/gltf.h"

namespace penumbra::scenes::gltf {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t max_elements = 200'000;  ///< of any list of the document

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// JSON chunk of a binary file, or the whole text. Checks the container (glTF 2.0, 4.4).
std::string json_text(const std::string& bytes) {
  if (bytes.compare(0, 4, "glTF") != 0) return bytes;
  if (bytes.size() < 20) throw unreadable("the glTF binary ends within its header");
  if (word(bytes, 4) != 2)
    throw unsupported("the glTF binary is of version " + std::to_string(word(bytes, 4)) +
                      "; version 2 can be read");
  if (word(bytes, 8) != bytes.size())
    throw unreadable("the glTF binary says it has " + std::to_string(word(bytes, 8)) +
                     " bytes but has " + std::to_string(bytes.size()));
  const std::uint32_t length = word(bytes, 12);
  if (word(bytes, 16) != 0x4E4F534Au) throw unreadable("the glTF binary's first chunk is no JSON");
  if (length > bytes.size() - 20) throw unreadable("the glTF binary's JSON chunk is cut off");
  const std::size_t next = 20 + std::size_t{length};
  if (next < bytes.size() &&
      (bytes.size() - next < 8 || word(bytes, next) > bytes.size() - next - 8))
    throw unreadable("the glTF binary's second chunk is cut off");
  return bytes.substr(20, length);
}

void check_version(const json& document) {
  const auto asset = document.find("asset");
  std::string version;
  if (asset != document.end() && asset->is_object() && asset->contains("version") &&
      (*asset)["version"].is_string())
    version = (*asset)["version"].get<std::string>();
  // Version 1 keeps its elements by name, in objects.
  const bool by_name = document.contains("meshes") && document["meshes"].is_object();
  if (version.rfind("1.", 0) == 0 || (version.empty() && by_name))
    throw unsupported(
        "glTF version " + (version.empty() ? "1.0" : version) + " cannot be read; version 2.0 can",
        "asset.version");
  if (version.empty()) throw unreadable("asset.version is missing: no glTF file", "asset.version");
  if (version.rfind("2.", 0) != 0)
    throw unsupported("glTF version " + version.substr(0, 40) + " cannot be read; version 2.0 can",
                      "asset.version");
}

void check_extensions(const json& document) {
  static const std::set<std::string> known = {"KHR_lights_punctual",
                                              "KHR_texture_transform",
                                              "KHR_materials_unlit",
                                              "KHR_mesh_quantization",
                                              "KHR_materials_pbrSpecularGlossiness",
                                              "KHR_materials_specular",
                                              "KHR_materials_clearcoat",
                                              "KHR_materials_ior",
                                              "KHR_materials_emissive_strength"};
  if (!document.contains("extensionsRequired")) return;
  const json& list = document["extensionsRequired"];
  if (!list.is_array()) throw unreadable("extensionsRequired must be a list", "extensionsRequired");
  for (const json& name : list) {
    if (!name.is_string()) throw unreadable("extensionsRequired must be a list of names");
    if (known.count(name.get<std::string>()) == 0)
      throw unreadable("the file requires the extension " + name.get<std::string>().substr(0, 100) +
                           ", which is not supported",
                       "extensionsRequired");
  }
}

/// Every list must be a list of objects: later code and the parser rely on it.
void check_lists(const json& document) {
  for (const char* name :
       {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials",
        "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
    const auto list = document.find(name);
    if (list == document.end()) continue;
    if (!list->is_array()) throw unreadable(std::string(name) + " must be a list", name);
    if (list->size() > max_elements)
      throw unreadable(
          std::string(name) + " has more than " + std::to_string(max_elements) + " elements", name);
    for (std::size_t i = 0; i < list->size(); ++i)
      if (!(*list)[i].is_object()) throw unreadable(element(name, i) + " must be an object", name);
  }
}

void check_references(const json& document, const fs::path& folder, bool binary) {
  for (const char* name : {"buffers", "images"}) {
    const auto list = document.find(name);
    if (list == document.end()) continue;
    for (std::size_t i = 0; i < list->size(); ++i) {
      const json& entry = (*list)[i];
      const std::string where = element(name, i) + ".uri";
      if (!entry.contains("uri")) {
        if (std::string(name) == "buffers" && !(binary && i == 0))
          throw unreadable(where + " is missing", where);
        continue;
      }
      if (!entry["uri"].is_string()) throw unreadable(where + " must be a text", where);
      const auto& uri = entry["uri"].get_ref<const std::string&>();
      if (uri.rfind("data:", 0) == 0) continue;
      const fs::path file = resolve_inside(folder, uri, where);
      std::error_code ignored;
      if (std::string(name) == "buffers" && !fs::is_regular_file(file, ignored))
        throw unreadable(where + ": there is no file '" + uri.substr(0, 200) + "' beside the scene",
                         where);
    }
  }
}

/// Keeps an image as it is encoded; those in buffers are fetched later, with their bounds checked.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

fs::path inside(const std::string& name, void* folder) {
  const fs::path& base = *static_cast<const fs::path*>(folder);
  return resolve_inside(base, fs::path(name).lexically_relative(base).string(), "uri");
}

/// The parser opens files through these, and they open nothing outside the folder.
tinygltf::FsCallbacks callbacks_of(fs::path& folder) {
  tinygltf::FsCallbacks callbacks;
  callbacks.FileExists = [](const std::string&, void*) { return true; };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* err,
                               const std::string& name, void* user) {
    try {
      const std::string bytes = read_bytes(inside(name, user));
      out->assign(bytes.begin(), bytes.end());
      return true;
    } catch (const Error& error) {
      if (err != nullptr) *err += error.what();
      return false;
    }
  };
  callbacks.WriteWholeFile = nullptr;
  callbacks.user_data = &folder;
  return callbacks;
}

}  // namespace

std::string element(const char* list, std::size_t index, const std::string& name) {
  const std::string text = std::string(list) + "[" + std::to_string(index) + "]";
  return name.empty() ? text : text + " '" + name.substr(0, 100) + "'";
}

tinygltf::Model parse(const fs::path& file, json& document) {
  const std::string bytes = read_bytes(file);
  const bool binary = bytes.compare(0, 4, "glTF") == 0;
  document = parse_json(json_text(bytes), "the glTF");
  if (!document.is_object()) throw unreadable("the glTF document must be an object");
  check_version(document);
  check_lists(document);
  check_extensions(document);
  fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  check_references(document, folder, binary);

  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_encoded, nullptr);
  loader.SetFsCallbacks(callbacks_of(folder));
  std::string errors, warnings;
  bool read = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    read = binary ? loader.LoadBinaryFromMemory(
                        &model, &errors, &warnings,
                        reinterpret_cast<const unsigned char*>(bytes.data()), size, folder.string())
                  : loader.LoadASCIIFromString(&model, &errors, &warnings, bytes.data(), size,
                                               folder.string());
  } catch (const std::exception& error) {
    errors += error.what();
  }
  if (!read) {
    while (!errors.empty() && errors.back() == '\n') errors.pop_back();
    throw unreadable(errors.empty() ? "the glTF cannot be read" : errors);
  }
  return model;
}

}  // namespace penumbra::scenes::gltf
