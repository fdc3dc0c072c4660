#include <glm/gtc/quaternion.hpp>

#include "renderer/error.h"
#include "scenes/import/gltf.h"
#include "scenes/json_reader.h"

namespace penumbra::scenes::gltf {
namespace {

/// Values of an attribute of the extension, `components` per copy; empty where it has none.
std::vector<float> attribute(const tinygltf::Model& model, const tinygltf::Value& attributes,
                             const char* name, int components, const std::string& where) {
  if (!attributes.Has(name)) return {};
  const tinygltf::Value& accessor = attributes.Get(name);
  if (!accessor.IsNumber()) throw unreadable(where + "." + name + " names no accessor", where);
  std::vector<float> values =
      read_floats(model, accessor.GetNumberAsInt(), components, where + "." + name);
  for (const float value : values)
    if (!(std::abs(static_cast<double>(value)) <= max_coordinate))
      throw unreadable(where + "." + name + " has a value beyond 1e15, or none that is finite",
                       where);
  return values;
}

}  // namespace

std::vector<glm::dmat4> read_copies(const tinygltf::Model& model, const tinygltf::Node& node,
                                    const std::string& node_name) {
  const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
  if (extension == node.extensions.end()) return {glm::dmat4(1.0)};
  const std::string where = node_name + ".EXT_mesh_gpu_instancing";
  if (!extension->second.IsObject() || !extension->second.Has("attributes") ||
      !extension->second.Get("attributes").IsObject())
    throw unreadable(where + " has no attributes", where);
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  const auto moves = attribute(model, attributes, "TRANSLATION", 3, where);
  const auto turns = attribute(model, attributes, "ROTATION", 4, where);
  const auto scales = attribute(model, attributes, "SCALE", 3, where);
  const std::size_t count = std::max({moves.size() / 3, turns.size() / 4, scales.size() / 3});
  if ((!moves.empty() && moves.size() / 3 != count) ||
      (!turns.empty() && turns.size() / 4 != count) ||
      (!scales.empty() && scales.size() / 3 != count))
    throw unreadable(where + ": its attributes differ in length", where);
  if (count > max_instances)
    throw unreadable(where + " asks for more than " + std::to_string(max_instances) + " copies",
                     where);
  std::vector<glm::dmat4> copies(count, glm::dmat4(1.0));
  for (std::size_t i = 0; i < count; ++i) {
    glm::dmat4& matrix = copies[i];
    if (!turns.empty()) {
      const float* turn = &turns[4 * i];
      const glm::dquat rotation(turn[3], turn[0], turn[1], turn[2]);
      if (glm::length(rotation) < 1e-6) throw unreadable(where + ".ROTATION is zero", where);
      matrix = glm::mat4_cast(glm::normalize(rotation));
    }
    if (!scales.empty())
      for (int c = 0; c < 3; ++c)
        matrix[c] *= static_cast<double>(scales[3 * i + static_cast<std::size_t>(c)]);
    if (!moves.empty())
      matrix[3] = glm::dvec4(moves[3 * i], moves[3 * i + 1], moves[3 * i + 2], 1.0);
  }
  return copies;
}

}  // namespace penumbra::scenes::gltf
