#include "scenes/document.h"

#include <algorithm>
#include <limits>

#include "scenes/base64.h"
#include "scenes/document_meshes.h"
#include "scenes/generators/random.h"
#include "scenes/generators/solid.h"
#include "scenes/generators/textures.h"
#include "scenes/import/import.h"
#include "scenes/import/side_files.h"
#include "scenes/json_reader.h"
#include "scenes/picture_io.h"
#include "scenes/text.h"

namespace penumbra::scenes {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t max_depth = 64;

std::string at_index(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

/// Elements of a list of the document, none where the key is missing.
const json& list_of(JsonReader& reader, const std::string& key) {
  static const json empty = json::array();
  if (!reader.has(key)) return empty;
  const json& list = reader.at(key);
  if (!list.is_array()) reader.fail(key, "must be a list");
  return list;
}

fs::path file_of(JsonReader& reader, const fs::path& folder) {
  std::string name;
  reader.text("file", name);
  if (folder.empty()) reader.fail("file", "cannot be read: this document may name no files");
  const fs::path file = resolve_inside(folder, name, reader.path_of("file"));
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored))
    reader.fail("file", "names no file beside the scene: " + in_quotes(name));
  return file;
}

/// `most_bytes` is what its texels may take.
Texture read_texture(const json& value, const std::string& path, const fs::path& folder,
                     std::uint64_t most_bytes) {
  JsonReader reader(value, path);
  std::string name;
  reader.text("name", name);
  Texture texture;
  const auto take = [&](Image8 picture) {
    texture = {"", picture.width, picture.height, std::move(picture.pixels)};
  };
  try {
    if (reader.has("generator")) {
      std::string generator;
      std::int64_t size = 512, seed = 1;
      reader.text("generator", generator);
      reader.integer("size", size, 1, 4096);
      reader.integer("seed", seed, 0, 0xffffffff);
      if (static_cast<std::uint64_t>(size * size * 4) > most_bytes)
        throw unreadable("it takes more than the " + std::to_string(most_bytes >> 20) +
                         " MiB that are left for the scene's textures");
      texture = generate_texture(generator, static_cast<std::uint32_t>(size),
                                 static_cast<std::uint32_t>(seed));
    } else if (reader.has("file")) {
      take(decode_picture(read_bytes(file_of(reader, folder)), most_bytes));
    } else {
      std::string text;
      reader.at("png");
      reader.text("png", text);
      take(decode_picture(base64_decode(text, reader.path_of("png")), most_bytes));
    }
  } catch (const Error& error) {
    throw unreadable(path + ": " + error.what(),
                     error.field.rfind(path, 0) == 0 ? error.field : path);
  }
  reader.finish();
  if (!name.empty()) texture.name = name;
  return texture;
}

/// Index of an element by its number or its name.
template <class T>
std::size_t find(const json& value, const std::string& path, const std::vector<T>& list) {
  std::string names;
  if (value.is_number_integer() && value.get<std::int64_t>() >= 0 &&
      value.get<std::uint64_t>() < list.size())
    return value.get<std::size_t>();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (value.is_string() && list[i].name == value.get_ref<const std::string&>()) return i;
    if (i < 50) names += (names.empty() ? "" : ", ") + list[i].name;
  }
  throw unreadable(path + " must be the number or name of one of: " + names, path);
}

glm::dmat4 read_transform(JsonReader& reader) {
  if (reader.has("matrix")) {
    for (const char* other : {"position", "rotation", "scale"})
      if (reader.has(other)) reader.fail(other, "and matrix exclude each other");
    const auto n = read_numbers(reader.at("matrix"), reader.path_of("matrix"), -max_coordinate,
                                max_coordinate);
    if (n.size() != 16) reader.fail("matrix", "must have 16 numbers, column by column");
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = n[static_cast<std::size_t>(i)];
    return matrix;
  }
  glm::dvec3 position(0.0), rotation(0.0), scale(1.0);
  reader.vector("position", position, -max_coordinate, max_coordinate);
  reader.vector("rotation", rotation, -3600.0, 3600.0);
  if (reader.has("scale") && reader.at("scale").is_number()) {
    reader.number("scale", scale.x, -1e9, 1e9);
    scale = glm::dvec3(scale.x);
  } else {
    reader.vector("scale", scale, -1e9, 1e9);
  }
  return move(position) * turn_y(rotation.y) * turn_x(rotation.x) * turn_z(rotation.z) *
         stretch(scale);
}

Instance read_instance(const json& value, const std::string& path, const Scene& scene) {
  JsonReader reader(value, path);
  Instance instance;
  reader.text("name", instance.name);
  instance.mesh =
      static_cast<std::uint32_t>(find(reader.at("mesh"), reader.path_of("mesh"), scene.meshes));
  instance.world_from_object = read_transform(reader);
  reader.boolean("casts_shadow", instance.casts_shadow);
  reader.finish();
  return instance;
}

/// Adds everything another file draws; its lights and cameras stay behind.
void add_model(const json& value, const std::string& path, const fs::path& folder, Scene& scene) {
  JsonReader reader(value, path);
  if (!reader.has("file")) reader.fail("file", "is missing");
  const fs::path file = file_of(reader, folder);
  const glm::dmat4 transform = read_transform(reader);
  bool casts_shadow = true;
  reader.boolean("casts_shadow", casts_shadow);
  reader.finish();
  const std::string extension = lower_extension(file);
  const bool obj = extension == ".obj";
  if (!obj && extension != ".gltf" && extension != ".glb")
    reader.fail("file", "must end in .gltf, .glb or .obj");
  Scene model = obj ? import_obj(file, false) : import_gltf(file, false);
  if (texture_bytes(model) > max_texture_bytes - texture_bytes(scene))
    reader.fail("file", "has too many textures: those of a scene may take 1 GiB together");
  for (const std::string& note : model.notes) scene.notes.push_back(path + ": " + note);
  const auto textures = static_cast<int>(scene.textures.size());
  const auto materials = static_cast<std::uint32_t>(scene.materials.size());
  const auto meshes = static_cast<std::uint32_t>(scene.meshes.size());
  std::move(model.textures.begin(), model.textures.end(), std::back_inserter(scene.textures));
  for (Material material : model.materials) {
    if (material.texture >= 0) material.texture += textures;
    scene.materials.push_back(material);
  }
  for (Mesh& mesh : model.meshes) {
    for (Primitive& primitive : mesh.primitives) primitive.material += materials;
    scene.meshes.push_back(std::move(mesh));
  }
  for (Instance instance : model.instances) {
    instance.mesh += meshes;
    instance.world_from_object = transform * instance.world_from_object;
    instance.casts_shadow = instance.casts_shadow && casts_shadow;
    scene.instances.push_back(instance);
  }
}

template <class T>
void check_named(const std::vector<T>& list, const std::string& key) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name.empty())
      throw unreadable(at_index(key, i) + ".name is missing", at_index(key, i) + ".name");
    for (std::size_t k = 0; k < i; ++k)
      if (list[k].name == list[i].name)
        throw unreadable(at_index(key, i) + ".name is that of another one",
                         at_index(key, i) + ".name");
  }
}

}  // namespace

json parse_json(const std::string& text, const std::string& name) {
  // Counted beforehand: the parser's own callback makes it slow for long lists.
  std::size_t depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && (c == '[' || c == '{') && ++depth > max_depth)
      throw unreadable(name + " is nested deeper than " + std::to_string(max_depth) + " levels");
    else if (!quoted && (c == ']' || c == '}') && depth > 0)
      --depth;
  }
  try {
    return json::parse(text);
  } catch (const json::exception& error) {
    // Names in older encodings are common and harmless: their bytes are replaced.
    const std::string repaired = valid_text(text);
    if (repaired != text) return parse_json(repaired, name);
    throw unreadable(name + " is no JSON: " + shortened(error.what()));
  }
}

Scene read_document(const json& document, const fs::path& folder,
                    std::uint64_t most_texture_bytes) {
  JsonReader reader(document, "");
  std::int64_t version = 0;
  reader.at("penumbra_scene");
  reader.integer("penumbra_scene", version, 1, 1);
  Scene scene;
  reader.text("id", scene.id);
  reader.text("title", scene.title);
  const json& textures = list_of(reader, "textures");
  for (std::size_t i = 0; i < textures.size(); ++i)
    scene.textures.push_back(read_texture(textures[i], at_index("textures", i), folder,
                                          most_texture_bytes - texture_bytes(scene)));
  const json& materials = list_of(reader, "materials");
  for (std::size_t i = 0; i < materials.size(); ++i) {
    json value = materials[i];
    const std::string path = at_index("materials", i);
    if (value.is_object() && value.contains("texture") && value["texture"].is_string())
      value["texture"] = find(value["texture"], path + ".texture", scene.textures);
    read_material(value, path, scene.materials.emplace_back());
  }
  const json& meshes = list_of(reader, "meshes");
  std::vector<glm::dvec3> origins(meshes.size());
  for (std::size_t i = 0; i < meshes.size(); ++i)
    scene.meshes.push_back(read_mesh(
        meshes[i], at_index("meshes", i),
        [&](const json& value, const std::string& path) {
          return static_cast<std::uint32_t>(find(value, path, scene.materials));
        },
        origins[i]));
  const json& instances = list_of(reader, "instances");
  for (std::size_t i = 0; i < instances.size(); ++i) {
    scene.instances.push_back(read_instance(instances[i], at_index("instances", i), scene));
    Instance& instance = scene.instances.back();
    instance.world_from_object = instance.world_from_object * move(origins[instance.mesh]);
  }
  const json& models = list_of(reader, "models");
  for (std::size_t i = 0; i < models.size(); ++i)
    add_model(models[i], at_index("models", i), folder, scene);
  const json& lights = list_of(reader, "lights");
  for (std::size_t i = 0; i < lights.size(); ++i)
    read_light(lights[i], at_index("lights", i), scene.lights.emplace_back());
  const json& cameras = list_of(reader, "cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i)
    read_camera(cameras[i], at_index("cameras", i), scene.cameras.emplace_back());
  check_named(scene.lights, "lights");
  check_named(scene.cameras, "cameras");
  json surroundings = json::object();
  for (const char* key :
       {"receivers", "shadow_planes", "ambient", "background_low", "background_high", "exposure"})
    if (reader.has(key)) surroundings[key] = reader.at(key);
  read_surroundings(surroundings, "", scene);
  reader.finish();
  if (scene.cameras.empty() || scene.lights.empty()) complete_import(scene);
  return scene;
}

json write_document(const Scene& scene) {
  json document = write_surroundings(scene);
  document["penumbra_scene"] = 1;
  document["id"] = scene.id;
  document["title"] = scene.title;
  for (const char* key : {"textures", "materials", "meshes", "instances", "lights", "cameras"})
    document[key] = json::array();
  for (const Texture& texture : scene.textures) {
    Image8 picture(texture.width, texture.height, 4);
    picture.pixels = texture.rgba;
    document["textures"].push_back(
        {{"name", texture.name}, {"png", base64_encode(encode_png(picture))}});
  }
  for (const Material& material : scene.materials)
    document["materials"].push_back(write_material(material));
  for (const Mesh& mesh : scene.meshes) document["meshes"].push_back(write_mesh(mesh));
  for (const Instance& instance : scene.instances) {
    json matrix = json::array();
    for (int i = 0; i < 16; ++i) matrix.push_back(instance.world_from_object[i / 4][i % 4]);
    document["instances"].push_back({{"name", instance.name},
                                     {"mesh", instance.mesh},
                                     {"matrix", matrix},
                                     {"casts_shadow", instance.casts_shadow}});
  }
  for (const Light& light : scene.lights) document["lights"].push_back(write_light(light));
  for (const Camera& camera : scene.cameras) document["cameras"].push_back(write_camera(camera));
  return document;
}

}  // namespace penumbra::scenes
