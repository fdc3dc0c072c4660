#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <tuple>

#include "renderer/error.h"
#include "scenes/generators/solid.h"
#include "scenes/import/import.h"
#include "scenes/picture_io.h"

namespace penumbra::scenes {
namespace fs = std::filesystem;
namespace {

/// Opens material files beside the model and nowhere else.
class FolderReader : public tinyobj::MaterialReader {
 public:
  FolderReader(fs::path folder_, std::vector<std::string>& notes_)
      : folder(std::move(folder_)), notes(notes_) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* map, std::string* warnings,
                  std::string* errors) override {
    const fs::path file = resolve_inside(folder, name, "mtllib");
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) {
      notes.push_back("the material file '" + name + "' is missing: materials are grey");
      return true;
    }
    std::istringstream stream(read_bytes(file));
    tinyobj::LoadMtl(map, materials, &stream, warnings, errors);
    return true;
  }

 private:
  fs::path folder;
  std::vector<std::string>& notes;
};

int load_texture(const std::string& name, const fs::path& folder, std::map<std::string, int>& known,
                 Scene& scene) {
  if (name.empty()) return -1;
  const auto [entry, added] = known.try_emplace(name, -1);
  if (!added) return entry->second;
  std::string portable = name;
  for (char& c : portable)
    if (c == '\\') c = '/';
  const fs::path file = resolve_inside(folder, portable, "map_Kd");
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    scene.notes.push_back("the texture '" + name + "' is missing: it is left out");
    return -1;
  }
  Image8 picture = read_picture(file);
  scene.textures.push_back({name, picture.width, picture.height, std::move(picture.pixels)});
  return entry->second = static_cast<int>(scene.textures.size()) - 1;
}

float share(double value) {
  return std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : 0.0f;
}

Material material_of(const tinyobj::material_t& from, int texture) {
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
  return material;
}

glm::vec3 triple(const std::vector<tinyobj::real_t>& values, int index) {
  const auto at = 3 * static_cast<std::size_t>(index);
  return {values[at], values[at + 1], values[at + 2]};
}

/// One mesh of a shape; triangles are grouped by material.
Mesh mesh_of(const tinyobj::shape_t& shape, const tinyobj::attrib_t& attributes,
             std::uint32_t materials, bool colored, const std::string& where) {
  Mesh mesh;
  mesh.name = shape.name;
  bool normals = true, uvs = false;
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_material;
  std::map<std::tuple<int, int, int>, std::uint32_t> known;
  const auto count = [](const auto& list, std::size_t width) {
    return static_cast<int>(list.size() / width);
  };
  for (std::size_t f = 0; f < shape.mesh.num_face_vertices.size(); ++f) {
    const int given = f < shape.mesh.material_ids.size() ? shape.mesh.material_ids[f] : -1;
    const std::uint32_t material = given < 0 || given >= static_cast<int>(materials)
                                       ? materials
                                       : static_cast<std::uint32_t>(given);
    for (std::size_t k = 0; k < 3; ++k) {
      if (3 * f + k >= shape.mesh.indices.size())
        throw unreadable(where + " has an incomplete face");
      const tinyobj::index_t& corner = shape.mesh.indices[3 * f + k];
      if (corner.vertex_index < 0 || corner.vertex_index >= count(attributes.vertices, 3))
        throw unreadable(where + " has a face with the vertex " +
                         std::to_string(corner.vertex_index + 1L) + " of " +
                         std::to_string(count(attributes.vertices, 3)));
      const bool has_normal =
          corner.normal_index >= 0 && corner.normal_index < count(attributes.normals, 3);
      const bool has_uv =
          corner.texcoord_index >= 0 && corner.texcoord_index < count(attributes.texcoords, 2);
      normals = normals && has_normal;
      uvs = uvs || has_uv;
      const auto [entry, added] =
          known.try_emplace(std::tuple(corner.vertex_index, has_normal ? corner.normal_index : -1,
                                       has_uv ? corner.texcoord_index : -1),
                            static_cast<std::uint32_t>(mesh.positions.size()));
      if (added) {
        mesh.positions.push_back(triple(attributes.vertices, corner.vertex_index));
        const glm::vec3 normal =
            has_normal ? triple(attributes.normals, corner.normal_index) : glm::vec3(0.0f);
        const float length = glm::length(normal);
        normals = normals && std::isfinite(length) && length > 1e-6f;
        mesh.normals.push_back(length > 1e-6f ? normal / length : normal);
        const auto uv = 2 * static_cast<std::size_t>(has_uv ? corner.texcoord_index : 0);
        // OBJ counts v from below.
        mesh.uvs.push_back(
            has_uv ? glm::vec2(attributes.texcoords[uv], 1.0f - attributes.texcoords[uv + 1])
                   : glm::vec2(0.0f));
        if (colored) mesh.colors.emplace_back(triple(attributes.colors, corner.vertex_index), 1.0f);
      }
      by_material[material].push_back(entry->second);
    }
  }
  for (const auto& [material, indices] : by_material) {
    mesh.primitives.push_back({static_cast<std::uint32_t>(mesh.indices.size()),
                               static_cast<std::uint32_t>(indices.size()), material});
    mesh.indices.insert(mesh.indices.end(), indices.begin(), indices.end());
  }
  if (!uvs) mesh.uvs.clear();
  if (!normals) compute_normals(mesh, 40.0);
  return mesh;
}

/// Whether any vertex has a colour of its own: the loader fills in white where there is none.
bool has_colors(const tinyobj::attrib_t& attributes) {
  if (attributes.colors.size() != attributes.vertices.size()) return false;
  for (const tinyobj::real_t value : attributes.colors)
    if (value != 1.0f) return true;
  return false;
}

}  // namespace

Scene import_obj(const fs::path& file, bool complete) {
  Scene scene;
  scene.id = scene.title = file.stem().string();
  const fs::path folder = file.parent_path();
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, errors;
  std::istringstream stream(read_bytes(file));
  FolderReader reader(folder, scene.notes);
  bool read = false;
  try {
    read = tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &errors, &stream, &reader,
                            true);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    errors += error.what();
  }
  while (!errors.empty() && errors.back() == '\n') errors.pop_back();
  if (!read) throw unreadable("the OBJ cannot be read" + (errors.empty() ? "" : ": " + errors));
  std::map<std::string, int> textures;
  for (const tinyobj::material_t& material : materials)
    scene.materials.push_back(
        material_of(material, load_texture(material.diffuse_texname, folder, textures, scene)));
  Material plain;
  plain.name = "default";
  plain.double_sided = true;
  scene.materials.push_back(plain);
  const bool colored = has_colors(attributes);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::string where =
        "shape " + std::to_string(i + 1) + " '" + shapes[i].name.substr(0, 100) + "'";
    Mesh mesh = mesh_of(shapes[i], attributes, static_cast<std::uint32_t>(materials.size()),
                        colored, where);
    if (mesh.indices.empty()) {
      scene.notes.push_back(where + " has no faces: it is left out");
      continue;
    }
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({scene.meshes.back().name,
                               static_cast<std::uint32_t>(scene.meshes.size() - 1), glm::dmat4(1.0),
                               true});
  }
  if (scene.instances.empty()) throw unreadable("the file has no faces to draw");
  if (complete) complete_import(scene);
  return scene;
}

}  // namespace penumbra::scenes
