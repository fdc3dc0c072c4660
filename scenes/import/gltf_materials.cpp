#include <algorithm>
#include <cmath>
#include <map>

#include "renderer/error.h"
#include "scenes/import/gltf.h"
#include "scenes/import/side_files.h"

namespace penumbra::scenes::gltf {
namespace {

double number_of(const tinygltf::Value& object, const char* key, double otherwise) {
  if (!object.IsObject() || !object.Has(key)) return otherwise;
  const tinygltf::Value& value = object.Get(key);
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
  return std::isfinite(number) ? number : otherwise;
}

glm::dvec2 pair_of(const tinygltf::Value& object, const char* key, const glm::dvec2& otherwise) {
  if (!object.IsObject() || !object.Has(key)) return otherwise;
  const tinygltf::Value& value = object.Get(key);
  if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(0).IsNumber() ||
      !value.Get(1).IsNumber())
    return otherwise;
  return {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
}

float share(double value, double otherwise) {
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : otherwise);
}

/// Bytes of an encoded image: kept by the parser, or in a buffer view.
std::string_view encoded_image(const tinygltf::Model& model, const tinygltf::Image& image,
                               const std::string& where) {
  if (image.bufferView < 0)
    return {reinterpret_cast<const char*>(image.image.data()), image.image.size()};
  if (static_cast<std::size_t>(image.bufferView) >= model.bufferViews.size())
    throw unreadable(where + " names no buffer view", where);
  const auto& view = model.bufferViews[static_cast<std::size_t>(image.bufferView)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
    throw unreadable(where + ": its buffer view names no buffer", where);
  const auto& bytes = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    throw unreadable(where + ": its buffer view reaches beyond the buffer", where);
  return {reinterpret_cast<const char*>(bytes.data()) + view.byteOffset, view.byteLength};
}

/// Decodes an image only if a material shows it.
class Textures {
 public:
  Textures(const tinygltf::Model& model_, Scene& scene, Notes& notes_)
      : model(model_), notes(notes_), store(scene, notes_, max_texture_bytes) {}

  int use(int texture, const std::string& where) {
    if (texture < 0) return -1;
    const int source = source_of(texture, where);
    if (source < 0) {
      notes.add(where, " has no image that can be read: it is left out");
      return -1;
    }
    const auto [entry, added] = known.try_emplace(source, -1);
    if (!added) return entry->second;
    const auto index = static_cast<std::size_t>(source);
    const tinygltf::Image& image = model.images[index];
    const std::string name = element("images", index, image.name);
    std::string_view bytes;
    try {
      bytes = encoded_image(model, image, name);
    } catch (const Error& error) {
      notes.add("", std::string(error.what()) + ": it is left out");
      return -1;
    }
    // That its file is not there has been told where it was looked for.
    if (!bytes.empty() || image.uri.empty()) entry->second = store.add(image.name, bytes, name);
    return entry->second;
  }

  /// All textures in their order, whatever they show.
  void use_all() {
    for (std::size_t i = 0; i < model.textures.size(); ++i) {
      const int source = source_of(static_cast<int>(i), element("textures", i));
      if (source < 0) throw unreadable(element("textures", i) + " names no image");
      const tinygltf::Image& image = model.images[static_cast<std::size_t>(source)];
      const std::string name = element("images", static_cast<std::size_t>(source), image.name);
      store.add_in_order(image.name, encoded_image(model, image, name), name);
    }
  }

  /// Whether a texture goes on beyond its borders; where it does not that is approximated.
  bool repeats(int texture) const {
    if (texture < 0 || static_cast<std::size_t>(texture) >= model.textures.size()) return true;
    const int sampler = model.textures[static_cast<std::size_t>(texture)].sampler;
    if (sampler < 0 || static_cast<std::size_t>(sampler) >= model.samplers.size()) return true;
    const tinygltf::Sampler& wrap = model.samplers[static_cast<std::size_t>(sampler)];
    return wrap.wrapS == TINYGLTF_TEXTURE_WRAP_REPEAT && wrap.wrapT == TINYGLTF_TEXTURE_WRAP_REPEAT;
  }

 private:
  int source_of(int texture, const std::string& where) const {
    if (static_cast<std::size_t>(texture) >= model.textures.size())
      throw unreadable(where + " names no texture", where);
    const int source = model.textures[static_cast<std::size_t>(texture)].source;
    if (source >= static_cast<int>(model.images.size()))
      throw unreadable(element("textures", static_cast<std::size_t>(texture)) + " names no image");
    return source;
  }

  const tinygltf::Model& model;
  Notes& notes;
  TextureStore store;
  std::map<int, int> known;
};

TextureUse use_of(int set, const tinygltf::ExtensionMap& extensions) {
  TextureUse use;
  use.set = std::clamp(set, 0, 15);
  const auto found = extensions.find("KHR_texture_transform");
  if (found == extensions.end()) return use;
  use.offset = pair_of(found->second, "offset", {0.0, 0.0});
  use.scale = pair_of(found->second, "scale", {1.0, 1.0});
  use.rotation = number_of(found->second, "rotation", 0.0);
  use.set = std::clamp(static_cast<int>(number_of(found->second, "texCoord", use.set)), 0, 15);
  return use;
}

/// Blinn-Phong's exponent with the lobe of a microfacet roughness: 2 / alpha^2 - 2, alpha =
/// roughness^2 (Walter et al. 2007, section 5.2, for the Phong distribution), no sharper than 256.
float shininess_of(double roughness) {
  const double alpha = std::max(roughness * roughness, 1e-3);
  return static_cast<float>(std::clamp(2.0 / (alpha * alpha) - 2.0, 1.0, 256.0));
}

glm::vec3 color_of(const std::vector<double>& factor) {
  glm::vec3 color(1.0f);
  for (int c = 0; c < 3 && c < static_cast<int>(factor.size()); ++c)
    color[c] = share(factor[static_cast<std::size_t>(c)], 1.0);
  return color;
}

/// Older files: diffuse colour and texture by KHR_materials_pbrSpecularGlossiness.
void read_diffuse(const tinygltf::Value& extension, Textures& textures, const std::string& where,
                  Material& material, TextureUse& use) {
  if (!extension.IsObject()) return;
  if (extension.Has("diffuseFactor") && extension.Get("diffuseFactor").IsArray()) {
    const tinygltf::Value& factor = extension.Get("diffuseFactor");
    for (int c = 0; c < 3 && c < static_cast<int>(factor.ArrayLen()); ++c)
      if (factor.Get(c).IsNumber())
        material.base_color[c] = share(factor.Get(c).GetNumberAsDouble(), 1.0);
  }
  if (!extension.Has("diffuseTexture") || !extension.Get("diffuseTexture").IsObject()) return;
  const tinygltf::Value& info = extension.Get("diffuseTexture");
  material.texture =
      textures.use(static_cast<int>(number_of(info, "index", -1.0)), where + ".diffuseTexture");
  use = use_of(static_cast<int>(number_of(info, "texCoord", 0.0)), {});
}

/// Tells what a material has and is not drawn.
void tell_left_out(const tinygltf::Material& from, const std::string& where, Notes& notes) {
  if (from.emissiveTexture.index >= 0) notes.add(where, ": its emissive texture is left out");
  if (from.normalTexture.index >= 0) notes.add(where, ": its normal map is left out");
  if (from.occlusionTexture.index >= 0) notes.add(where, ": its occlusion map is left out");
  if (from.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0)
    notes.add(where, ": its metal and roughness map is drawn as one roughness");
  if (from.extensions.count("KHR_materials_unlit") != 0)
    notes.add(where, " is unlit in the file and lit here");
  if (from.alphaMode == "BLEND")
    notes.add(where, " is blended in the file and cut at half its alpha here");
}

Material read_material(const tinygltf::Material& from, Textures& textures, const std::string& where,
                       TextureUse& use, Notes& notes) {
  Material material;
  material.name = from.name;
  const auto& pbr = from.pbrMetallicRoughness;
  material.base_color = color_of(pbr.baseColorFactor);
  if (pbr.baseColorFactor.size() == 4) material.alpha = share(pbr.baseColorFactor[3], 1.0);
  material.texture = textures.use(pbr.baseColorTexture.index, where + ".baseColorTexture");
  use = use_of(pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions);
  use.repeats = textures.repeats(pbr.baseColorTexture.index);
  const float metallic = share(pbr.metallicFactor, 1.0);
  const bool textured_metal = pbr.metallicRoughnessTexture.index >= 0;
  material.specular = textured_metal ? 0.06f : 0.04f + 0.26f * metallic;
  material.shininess =
      shininess_of(textured_metal ? 0.6 : static_cast<double>(share(pbr.roughnessFactor, 1.0)));
  if (from.emissiveFactor.size() == 3)
    for (int c = 0; c < 3; ++c)
      material.emissive[c] = share(from.emissiveFactor[static_cast<std::size_t>(c)], 0.0);
  if (from.emissiveTexture.index >= 0) material.emissive = glm::vec3(0.0f);
  const auto older = from.extensions.find("KHR_materials_pbrSpecularGlossiness");
  if (older != from.extensions.end()) read_diffuse(older->second, textures, where, material, use);
  if (from.alphaMode == "MASK" || from.alphaMode == "BLEND") {
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = from.alphaMode == "MASK" ? share(from.alphaCutoff, 0.5) : 0.5f;
  }
  material.double_sided = from.doubleSided;
  use.textured = material.texture >= 0;
  tell_left_out(from, where, notes);
  return material;
}

}  // namespace

std::vector<TextureUse> read_materials(const tinygltf::Model& model, bool all_textures,
                                       Scene& scene, Notes& notes) {
  Textures textures(model, scene, notes);
  // The materials of a file of ours name textures by their place.
  if (all_textures) textures.use_all();
  std::vector<TextureUse> uses;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    TextureUse use;
    const std::string where = element("materials", i, model.materials[i].name);
    if (!all_textures)
      scene.materials.push_back(read_material(model.materials[i], textures, where, use, notes));
    uses.push_back(use);
  }
  Material plain;
  plain.name = "default";
  scene.materials.push_back(plain);
  uses.push_back({});
  return uses;
}

}  // namespace penumbra::scenes::gltf
