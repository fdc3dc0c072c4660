#include "scenes/export.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "renderer/error.h"
#include "renderer/scene/light.h"
#include "scenes/document.h"
#include "scenes/json_text.h"
#include "scenes/picture_io.h"

namespace penumbra::scenes {
namespace {

using nlohmann::json;

constexpr double radians = 0.017453292519943295;

/// The binary chunk and the views into it.
class BufferWriter {
 public:
  int add_view(const void* data, std::size_t size, int target) {
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    bytes.append(static_cast<const char*>(data), size);
    views.push_back(view);
    return static_cast<int>(views.size()) - 1;
  }

  template <int N>
  int add_vectors(const std::vector<glm::vec<N, float>>& list, bool bounds) {
    constexpr int array_buffer = 34962, float_type = 5126;
    json accessor = {
        {"bufferView", add_view(list.data(), list.size() * sizeof(list[0]), array_buffer)},
        {"componentType", float_type},
        {"count", list.size()},
        {"type", "VEC" + std::to_string(N)}};
    if (bounds) {
      glm::vec<N, float> low = list.front(), high = list.front();
      for (const auto& vector : list) {
        low = glm::min(low, vector);
        high = glm::max(high, vector);
      }
      for (int c = 0; c < N; ++c) {
        accessor["min"].push_back(low[c]);
        accessor["max"].push_back(high[c]);
      }
    }
    accessors.push_back(accessor);
    return static_cast<int>(accessors.size()) - 1;
  }

  int add_indices(int view, const Primitive& primitive) {
    constexpr int unsigned_int = 5125;
    accessors.push_back({{"bufferView", view},
                         {"byteOffset", std::size_t{primitive.first_index} * 4},
                         {"componentType", unsigned_int},
                         {"count", primitive.index_count},
                         {"type", "SCALAR"}});
    return static_cast<int>(accessors.size()) - 1;
  }

  std::string bytes;
  json views = json::array();
  json accessors = json::array();
};

json gltf_material(const Material& material) {
  // Roughness whose lobe is as wide as the exponent's; inverse of the import.
  const double roughness =
      std::sqrt(std::sqrt(2.0 / (static_cast<double>(material.shininess) + 2.0)));
  json pbr = {
      {"baseColorFactor",
       json_list(glm::vec4(glm::min(material.base_color, glm::vec3(1.0f)), material.alpha))},
      {"metallicFactor", 0.0},
      {"roughnessFactor", std::clamp(roughness, 0.0, 1.0)}};
  if (material.texture >= 0) pbr["baseColorTexture"] = {{"index", material.texture}};
  json value = {{"name", material.name},
                {"pbrMetallicRoughness", pbr},
                {"emissiveFactor", json_list(glm::min(material.emissive, glm::vec3(1.0f)))},
                {"doubleSided", material.double_sided}};
  if (material.alpha_mode == AlphaMode::mask) {
    value["alphaMode"] = "MASK";
    value["alphaCutoff"] = material.alpha_cutoff;
  }
  return value;
}

json gltf_mesh(const Mesh& mesh, BufferWriter& buffer) {
  constexpr int element_array_buffer = 34963;
  json value = {{"name", mesh.name}, {"primitives", json::array()}};
  if (mesh.indices.empty())
    throw unsupported("the mesh '" + mesh.name + "' has no triangles, which glTF cannot say");
  json attributes = {{"POSITION", buffer.add_vectors(mesh.positions, true)},
                     {"NORMAL", buffer.add_vectors(mesh.normals, false)}};
  if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = buffer.add_vectors(mesh.uvs, false);
  if (!mesh.colors.empty()) attributes["COLOR_0"] = buffer.add_vectors(mesh.colors, false);
  const int view =
      buffer.add_view(mesh.indices.data(), mesh.indices.size() * 4, element_array_buffer);
  for (const Primitive& primitive : mesh.primitives)
    value["primitives"].push_back({{"attributes", attributes},
                                   {"indices", buffer.add_indices(view, primitive)},
                                   {"material", primitive.material}});
  return value;
}

json matrix_of(const glm::dmat4& matrix) {
  json list = json::array();
  for (int i = 0; i < 16; ++i) list.push_back(matrix[i / 4][i % 4]);
  return list;
}

/// Node that looks along -z with y up, as glTF's lights and cameras do.
json looking(const glm::dvec3& position, const glm::dvec3& direction, const glm::dvec3& up) {
  const glm::dvec3 back = -glm::normalize(direction);
  const glm::dvec3 right = glm::normalize(glm::cross(up, back));
  glm::dmat4 matrix(1.0);
  matrix[0] = glm::dvec4(right, 0.0);
  matrix[1] = glm::dvec4(glm::cross(back, right), 0.0);
  matrix[2] = glm::dvec4(back, 0.0);
  matrix[3] = glm::dvec4(position, 1.0);
  return matrix_of(matrix);
}

json gltf_light(const Light& light) {
  json value = {{"name", light.name},
                {"type", name_of(light.kind)},
                {"color", json_list(glm::min(light.color, glm::vec3(1.0f)))},
                {"intensity", light.intensity}};
  if (range_of(light) > 0.0) value["range"] = range_of(light);
  if (const auto cone = cone_of(light))
    value["spot"] = {{"innerConeAngle", radians * cone->inner_angle * 0.9999},
                     {"outerConeAngle", radians * cone->outer_angle}};
  return value;
}

json gltf_camera(const Camera& camera) {
  if (camera.projection == Projection::orthographic)
    return {{"name", camera.name},
            {"type", "orthographic"},
            {"orthographic",
             {{"xmag", 0.5 * camera.orthographic_height},
              {"ymag", 0.5 * camera.orthographic_height},
              {"znear", camera.near_plane},
              {"zfar", camera.near_plane + 1e6}}}};
  return {{"name", camera.name},
          {"type", "perspective"},
          {"perspective", {{"yfov", radians * camera.vertical_fov}, {"znear", camera.near_plane}}}};
}

/// What glTF has no words for, and what it would round.
json extras_of(const Scene& scene) {
  json extras = {{"version", 1},
                 {"id", scene.id},
                 {"title", scene.title},
                 {"surroundings", write_surroundings(scene)}};
  for (const char* key : {"lights", "cameras", "materials", "casts_shadow"})
    extras[key] = json::array();
  for (const Light& light : scene.lights) extras["lights"].push_back(write_light(light));
  for (const Camera& camera : scene.cameras) extras["cameras"].push_back(write_camera(camera));
  for (const Material& material : scene.materials)
    extras["materials"].push_back(write_material(material));
  for (const Instance& instance : scene.instances)
    extras["casts_shadow"].push_back(instance.casts_shadow);
  if (!scene.notes.empty()) extras["notes"] = scene.notes;
  return {{"penumbra", extras}};
}

json gltf_nodes(const Scene& scene) {
  json nodes = json::array();
  for (const Instance& instance : scene.instances)
    nodes.push_back({{"name", instance.name},
                     {"mesh", instance.mesh},
                     {"matrix", matrix_of(instance.world_from_object)}});
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[i];
    nodes.push_back(
        {{"name", camera.name},
         {"camera", i},
         {"matrix", looking(camera.position, camera.target - camera.position, camera.up)}});
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    nodes.push_back({{"name", light.name},
                     {"matrix", looking(light.position, light.direction, light.up)},
                     {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  }
  return nodes;
}

void append_word(std::string& bytes, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

/// Header and two chunks (glTF 2.0, 4.4).
std::string container_of(std::string text, std::string binary) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const std::size_t total = 12 + 8 + text.size() + 8 + binary.size();
  if (total > 0xffffffffu)
    throw unsupported("the scene is larger than a glTF binary may be: 4 GiB");
  std::string bytes = "glTF";
  append_word(bytes, 2);
  append_word(bytes, total);
  append_word(bytes, text.size());
  append_word(bytes, 0x4E4F534A);
  bytes += text;
  append_word(bytes, binary.size());
  append_word(bytes, 0x004E4942);
  return bytes + binary;
}

}  // namespace

std::string encode_glb(const Scene& scene) {
  BufferWriter buffer;
  json document = {
      {"asset", {{"version", "2.0"}, {"generator", "Penumbra"}, {"extras", extras_of(scene)}}},
      {"scene", 0},
      {"nodes", gltf_nodes(scene)}};
  json all = json::array();
  for (std::size_t i = 0; i < document["nodes"].size(); ++i) all.push_back(i);
  document["scenes"] = json::array({{{"name", scene.title}, {"nodes", all}}});
  for (const Mesh& mesh : scene.meshes) document["meshes"].push_back(gltf_mesh(mesh, buffer));
  for (const Material& material : scene.materials)
    document["materials"].push_back(gltf_material(material));
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& texture = scene.textures[i];
    Image8 picture(texture.width, texture.height, 4);
    picture.pixels = texture.rgba;
    const std::string png = encode_png(picture);
    document["images"].push_back({{"name", texture.name},
                                  {"mimeType", "image/png"},
                                  {"bufferView", buffer.add_view(png.data(), png.size(), 0)}});
    document["textures"].push_back({{"source", i}});
  }
  for (const Camera& camera : scene.cameras) document["cameras"].push_back(gltf_camera(camera));
  if (!scene.lights.empty()) {
    json lights = json::array();
    for (const Light& light : scene.lights) lights.push_back(gltf_light(light));
    document["extensions"] = {{"KHR_lights_punctual", {{"lights", lights}}}};
    document["extensionsUsed"] = {"KHR_lights_punctual"};
  }
  document["bufferViews"] = buffer.views;
  document["accessors"] = buffer.accessors;
  document["buffers"] = json::array({{{"byteLength", buffer.bytes.size()}}});
  return container_of(document.dump(), std::move(buffer.bytes));
}

void export_glb(const Scene& scene, const std::filesystem::path& file) {
  const std::string bytes = encode_glb(scene);
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw bad_value("out", "cannot write " + file.string());
}

}  // namespace penumbra::scenes
