#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"
#include "scenes/import/import.h"
#include "scenes/import/notes.h"

/// Parts of the glTF import. Every index, offset and count of the model is checked where it is
/// used: the parser checks syntax only.
namespace penumbra::scenes::gltf {

/// "meshes[3] 'wheel'": how messages name an element.
std::string element(const char* list, std::size_t index, const std::string& name = {});

/// Container, syntax, version, required extensions and references checked; images still encoded in
/// Image::image where they are not in a buffer. `document` receives the JSON without its buffers
/// and images.
tinygltf::Model parse(const std::filesystem::path& file, nlohmann::json& document, Notes& notes);

/// Values of an accessor, `components` per element, normalised integers as -1..1 or 0..1.
/// Throws unreadable naming `where` for anything that leads outside the buffers.
std::vector<float> read_floats(const tinygltf::Model& model, int accessor, int components,
                               const std::string& where);
/// Components per element of an accessor (VEC3: 3).
int components_of(const tinygltf::Model& model, int accessor, const std::string& where);
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor,
                                        const std::string& where);

/// Which uvs a material's texture reads, and the transform to bake into them.
struct TextureUse {
  int set = 0;
  glm::dvec2 offset{0.0};
  double rotation = 0.0;  ///< radians, counter-clockwise
  glm::dvec2 scale{1.0};
  bool textured = false;
  bool repeats = true;  ///< its sampler repeats beyond 0..1
  bool operator==(const TextureUse&) const = default;
};

/// Fills textures, in their order if all are wanted, otherwise as materials show them, and
/// materials (the last one is glTF's default); one TextureUse per material.
std::vector<TextureUse> read_materials(const tinygltf::Model& model, bool all_textures,
                                       Scene& scene, Notes& notes);

/// Fills meshes, one per glTF mesh; those without triangles stay empty.
void read_meshes(const tinygltf::Model& model, const std::vector<TextureUse>& uses, Scene& scene,
                 Notes& notes);

/// Fills instances, lights and cameras from the node hierarchy.
void read_nodes(const tinygltf::Model& model, Scene& scene, Notes& notes);

/// Places of the copies of a node's mesh that EXT_mesh_gpu_instancing asks for, in its own space;
/// one at the origin where it asks for none.
std::vector<glm::dmat4> read_copies(const tinygltf::Model& model, const tinygltf::Node& node,
                                    const std::string& where);

/// Instances of a scene: far more than are seen, and each takes memory where a file takes none.
constexpr std::size_t max_instances = 1'000'000;

/// Corners of all triangles that are drawn together; 5 million triangles have 15 million.
constexpr std::size_t max_corners = 100'000'000;

/// Sets exposure, ambient and background so that lights in physical units give a picture that is
/// neither black nor burnt. Metered over what the scene's first camera sees, so that nothing
/// outside of its picture changes it.
void expose(Scene& scene);

/// Scenes written by encode_glb: what glTF has no words for.
void read_extras(const nlohmann::json& document, Scene& scene);

}  // namespace penumbra::scenes::gltf
