#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>

#include "renderer/error.h"
#include "scenes/base64.h"
#include "scenes/document.h"
#include "scenes/import/gltf.h"
#include "scenes/import/side_files.h"
#include "scenes/text.h"

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

/// The two parts of a glTF file.
struct Parts {
  std::string text;
  std::string binary;  ///< of a binary file's second chunk
};

/// Checks the container (glTF 2.0, 4.4).
Parts parts_of(std::string bytes) {
  if (bytes.compare(0, 4, "glTF") != 0) return {std::move(bytes), {}};
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
  Parts parts{bytes.substr(20, length), {}};
  const std::size_t next = 20 + std::size_t{length};
  if (next < bytes.size()) {
    if (bytes.size() - next < 8 || word(bytes, next) > bytes.size() - next - 8)
      throw unreadable("the glTF binary's second chunk is cut off");
    if (word(bytes, next + 4) == 0x004E4942u)
      parts.binary = bytes.substr(next + 8, word(bytes, next));
  }
  return parts;
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

/// Extensions that are read, or told of where they are met.
const std::set<std::string> read_extensions = {
    "KHR_lights_punctual",   "KHR_texture_transform",
    "KHR_materials_unlit",   "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization", "EXT_mesh_gpu_instancing"};

/// Extensions without which a file still shows what it is meant to, nearly.
const std::set<std::string> dispensable_extensions = {
    "KHR_materials_specular", "KHR_materials_clearcoat", "KHR_materials_ior",
    "KHR_materials_emissive_strength"};

/// What is required must be known; what is left out is told.
void check_extensions(const json& document, Notes& notes) {
  for (const char* key : {"extensionsRequired", "extensionsUsed"}) {
    const auto list = document.find(key);
    if (list == document.end()) continue;
    if (!list->is_array()) throw unreadable(std::string(key) + " must be a list", key);
    for (const json& name : *list) {
      if (!name.is_string()) throw unreadable(std::string(key) + " must be a list of names", key);
      const std::string text = name;
      if (read_extensions.count(text) != 0) continue;
      if (std::string(key) == "extensionsUsed")
        notes.add("the extension " + in_quotes(text), " is left out");
      else if (dispensable_extensions.count(text) == 0)
        throw unreadable(
            "the file requires the extension " + in_quotes(text) + ", which is not supported", key);
    }
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

/// Bytes of a data URI (RFC 2397): any type, any case; base64 with or without padding, in either
/// alphabet. Throws unreadable.
std::string data_of(const std::string& uri, const std::string& where) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) throw unreadable(where + " is no data URI", where);
  std::string head = uri.substr(0, comma);
  for (char& c : head) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::string data = percent_decoded(uri.substr(comma + 1));
  if (!head.ends_with(";base64")) return data;
  std::erase_if(data, [](unsigned char c) { return std::isspace(c) != 0; });
  std::replace(data.begin(), data.end(), '-', '+');
  std::replace(data.begin(), data.end(), '_', '/');
  while (data.size() % 4 != 0) data += '=';
  return base64_decode(data, where);
}

bool is_data(const std::string& uri) {
  static const std::string scheme = "data:";
  return uri.size() >= scheme.size() &&
         std::equal(scheme.begin(), scheme.end(), uri.begin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

/// The uri of a buffer or an image; empty where there is none.
std::string uri_of(const json& entry, const std::string& where) {
  const auto uri = entry.find("uri");
  if (uri == entry.end()) return {};
  if (!uri->is_string()) throw unreadable(where + " must be a text", where);
  if (uri->get_ref<const std::string&>().empty()) throw unreadable(where + " is empty", where);
  return *uri;
}

/// What the parser reads in place of a buffer whose bytes were taken.
const json one_byte_buffer = {{"byteLength", 1},
                              {"uri", "data:application/octet-stream;base64,AA=="}};

/// Bytes of the document's buffers, which are replaced in it. Without one of them there is nothing
/// to draw, so that one that cannot be read is refused.
std::vector<std::string> take_buffers(json& document, std::string binary, const fs::path& folder) {
  std::vector<std::string> buffers;
  const auto list = document.find("buffers");
  for (std::size_t i = 0; list != document.end() && i < list->size(); ++i) {
    const std::string where = element("buffers", i) + ".uri";
    const std::string uri = uri_of((*list)[i], where);
    if (uri.empty()) {
      if (i > 0 || binary.empty()) throw unreadable(where + " is missing", where);
      buffers.push_back(std::move(binary));
    } else if (is_data(uri)) {
      buffers.push_back(data_of(uri, where));
    } else {
      const fs::path file = resolve_inside(folder, uri, where);
      std::error_code ignored;
      if (!fs::is_regular_file(file, ignored))
        throw unreadable(where + ": there is no file " + in_quotes(uri) + " beside the scene",
                         where);
      buffers.push_back(read_bytes(file));
    }
    (*list)[i] = one_byte_buffer;
  }
  return buffers;
}

/// An image as the document has it: bytes, or a buffer view.
struct EncodedImage {
  std::string uri;
  std::string bytes;
  int view = -1;
};

/// The document's images, which are replaced in it. One that cannot be read has no bytes, and a
/// note.
std::vector<EncodedImage> take_images(json& document, const fs::path& folder, Notes& notes) {
  std::vector<EncodedImage> images;
  SideFiles files(folder, notes);
  const auto list = document.find("images");
  for (std::size_t i = 0; list != document.end() && i < list->size(); ++i) {
    json& entry = (*list)[i];
    EncodedImage& image = images.emplace_back();
    const std::string where = element("images", i) + ".uri";
    const auto view = entry.find("bufferView");
    try {
      const std::string uri = uri_of(entry, where);
      if (is_data(uri)) {
        image.bytes = data_of(uri, where);
      } else if (!uri.empty()) {
        image.uri = uri;
        image.bytes = files.read(uri, where).value_or("");
      } else if (view != entry.end() && view->is_number_integer() && *view >= 0 &&
                 *view <= max_elements) {
        image.view = *view;
      }
    } catch (const Error& error) {
      notes.add("", std::string(error.what()) + ": it is left out");
    }
    const json name = entry.contains("name") ? entry["name"] : json();
    entry = {{"uri", "data:image/png;base64,AA=="}};
    if (name.is_string()) entry["name"] = name;
  }
  return images;
}

/// The parser is handed everything and opens nothing.
tinygltf::FsCallbacks no_files() {
  tinygltf::FsCallbacks callbacks;
  callbacks.FileExists = [](const std::string&, void*) { return false; };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&,
                               void*) { return false; };
  callbacks.WriteWholeFile = nullptr;
  callbacks.user_data = nullptr;
  return callbacks;
}

/// Images are decoded where a material shows them.
bool decode_nothing(tinygltf::Image*, const int, std::string*, std::string*, int, int,
                    const unsigned char*, int, void*) {
  return true;
}

}  // namespace

std::string element(const char* list, std::size_t index, const std::string& name) {
  const std::string text = std::string(list) + "[" + std::to_string(index) + "]";
  return name.empty() ? text : text + " " + in_quotes(name);
}

tinygltf::Model parse(const fs::path& file, json& document, Notes& notes) {
  Parts parts = parts_of(read_bytes(file));
  document = parse_json(parts.text, "the glTF");
  if (!document.is_object()) throw unreadable("the glTF document must be an object");
  check_version(document);
  check_lists(document);
  check_extensions(document, notes);
  std::vector<std::string> buffers =
      take_buffers(document, std::move(parts.binary), file.parent_path());
  std::vector<EncodedImage> images = take_images(document, file.parent_path(), notes);

  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(decode_nothing, nullptr);
  loader.SetFsCallbacks(no_files());
  std::string errors, warnings;
  bool read = false;
  try {
    const std::string text = document.dump();
    read = loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                      static_cast<unsigned int>(text.size()), "");
  } catch (const std::exception& error) {
    errors += error.what();
  }
  if (!read || model.buffers.size() != buffers.size() || model.images.size() != images.size()) {
    while (!errors.empty() && errors.back() == '\n') errors.pop_back();
    throw unreadable(errors.empty() ? "the glTF cannot be read" : errors);
  }
  for (std::size_t i = 0; i < buffers.size(); ++i)
    model.buffers[i].data.assign(buffers[i].begin(), buffers[i].end());
  for (std::size_t i = 0; i < images.size(); ++i) {
    model.images[i].bufferView = images[i].view;
    model.images[i].uri = images[i].uri;
    model.images[i].image.assign(images[i].bytes.begin(), images[i].bytes.end());
  }
  return model;
}

}  // namespace penumbra::scenes::gltf
