#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "renderer/error.h"
#include "scenes/import/gltf.h"
#include "scenes/json_reader.h"

namespace penumbra::scenes::gltf {
namespace {

constexpr int max_depth = 512;
constexpr double degrees = 57.29577951308232;

template <class List>
void check_finite(const List& values, const std::string& where) {
  for (const double value : values)
    if (!std::isfinite(value) || std::abs(value) > max_coordinate)
      throw unreadable(where + " has a transform beyond 1e15, or none that is finite", where);
}

glm::dmat4 local_matrix(const tinygltf::Node& node, const std::string& where) {
  for (const auto* list : {&node.matrix, &node.translation, &node.rotation, &node.scale})
    check_finite(*list, where);
  const auto check = [&](const std::vector<double>& list, std::size_t size, const char* name) {
    if (!list.empty() && list.size() != size)
      throw unreadable(where + "." + name + " must have " + std::to_string(size) + " numbers",
                       where);
    return !list.empty();
  };
  glm::dmat4 matrix(1.0);
  if (check(node.matrix, 16, "matrix")) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    if (matrix[0].w != 0.0 || matrix[1].w != 0.0 || matrix[2].w != 0.0 || matrix[3].w != 1.0)
      throw unreadable(where + ".matrix must be affine", where);
    return matrix;
  }
  if (check(node.rotation, 4, "rotation")) {
    const glm::dquat turn(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (glm::length(turn) < 1e-6) throw unreadable(where + ".rotation is zero", where);
    matrix = glm::mat4_cast(glm::normalize(turn));
  }
  if (check(node.scale, 3, "scale"))
    for (int c = 0; c < 3; ++c) matrix[c] *= node.scale[static_cast<std::size_t>(c)];
  if (check(node.translation, 3, "translation"))
    matrix[3] = {node.translation[0], node.translation[1], node.translation[2], 1.0};
  return matrix;
}

glm::dvec3 direction_of(const glm::dmat4& matrix, const glm::dvec3& axis,
                        const std::string& where) {
  const glm::dvec3 turned = glm::dmat3(matrix) * axis;
  const double length = glm::length(turned);
  if (!(length > 0.0) || !std::isfinite(length))
    throw unreadable(where + " has a transform without direction", where);
  return turned / length;
}

void add_camera(const tinygltf::Camera& from, const glm::dmat4& matrix, const std::string& where,
                Scene& scene) {
  Camera camera;
  camera.name = unique_name(scene.cameras, from.name.empty() ? "camera" : from.name);
  camera.position = glm::dvec3(matrix[3]);
  camera.target = camera.position + direction_of(matrix, {0, 0, -1}, where);
  camera.up = direction_of(matrix, {0, 1, 0}, where);
  double near_plane = from.perspective.znear;
  if (from.type == "orthographic") {
    camera.projection = Projection::orthographic;
    camera.orthographic_height = 2.0 * std::abs(from.orthographic.ymag);
    near_plane = from.orthographic.znear;
    if (!(camera.orthographic_height >= 1e-9 && camera.orthographic_height <= max_coordinate))
      throw unreadable(where + ".ymag must be above 0", where);
  } else {
    camera.vertical_fov = degrees * from.perspective.yfov;
    if (!(camera.vertical_fov > 0.0 && camera.vertical_fov < 180.0))
      throw unreadable(where + ".yfov must be above 0 and below pi", where);
  }
  // The ranges of a scene document.
  camera.vertical_fov = std::clamp(camera.vertical_fov, 0.01, 179.99);
  camera.near_plane = near_plane > 0.0 ? std::clamp(near_plane, 1e-9, max_coordinate) : 0.01;
  scene.cameras.push_back(camera);
}

void add_light(const tinygltf::Light& from, const glm::dmat4& matrix, const std::string& where,
               Scene& scene) {
  Light light;
  light.name = unique_name(scene.lights, from.name.empty() ? "light" : from.name);
  light.position = glm::dvec3(matrix[3]);
  light.direction = direction_of(matrix, {0, 0, -1}, where);
  light.up = direction_of(matrix, {0, 1, 0}, where);
  if (glm::length(glm::cross(light.direction, light.up)) < 1e-5)
    light.up = std::abs(light.direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  for (int c = 0; c < 3 && c < static_cast<int>(from.color.size()); ++c)
    light.color[c] = static_cast<float>(std::max(0.0, from.color[static_cast<std::size_t>(c)]));
  light.intensity = static_cast<float>(from.intensity);
  if (!(from.intensity >= 0.0 && from.intensity <= max_intensity))
    throw unreadable(where + ".intensity must be in 0..1e30", where);
  light.range = from.range > 0.0 && from.range <= max_coordinate ? from.range : 0.0;
  light.attenuation = Attenuation::inverse_square;
  if (from.type == "directional") {
    light.kind = LightKind::directional;
    light.attenuation = Attenuation::none;
    light.range = 0.0;
  } else if (from.type == "point") {
    light.kind = LightKind::point;
  } else if (from.type == "spot") {
    light.outer_angle = std::clamp(degrees * from.spot.outerConeAngle, 0.01, 89.9);
    light.inner_angle = std::clamp(degrees * from.spot.innerConeAngle, 0.0, light.outer_angle);
  } else {
    throw unreadable(where + ".type is none of glTF: '" + from.type.substr(0, 40) + "'", where);
  }
  scene.lights.push_back(light);
}

/// Adds what a node draws; `corners` counts those of all nodes.
void add_instances(const tinygltf::Model& model, const tinygltf::Node& node,
                   const std::string& where, const glm::dmat4& matrix, std::size_t& corners,
                   Scene& scene, Notes& notes) {
  const auto index = static_cast<std::size_t>(node.mesh);
  if (scene.meshes[index].indices.empty()) return;
  if (node.skin >= 0) notes.add(where, " is drawn as modelled: its skin is left out");
  for (const glm::dmat4& copy : read_copies(model, node, where)) {
    const glm::dmat4 place = matrix * copy;
    const double volume = glm::determinant(glm::dmat3(place));
    if (volume == 0.0 || !std::isfinite(volume)) {
      notes.add(where, " is scaled to nothing: it is left out");
      continue;
    }
    corners += scene.meshes[index].indices.size();
    if (corners > max_corners || scene.instances.size() >= max_instances)
      throw unreadable("the file has too many triangles or instances", where);
    scene.instances.push_back({node.name, static_cast<std::uint32_t>(index), place, true});
  }
}

void add_node(const tinygltf::Model& model, const tinygltf::Node& node, std::size_t index,
              const glm::dmat4& matrix, std::size_t& corners, Scene& scene, Notes& notes) {
  const std::string where = element("nodes", index, node.name);
  if (node.mesh >= static_cast<int>(scene.meshes.size()))
    throw unreadable(where + ".mesh names no mesh", where);
  if (node.mesh >= 0) add_instances(model, node, where, matrix, corners, scene, notes);
  if (node.camera >= static_cast<int>(model.cameras.size()))
    throw unreadable(where + ".camera names no camera", where);
  if (node.camera >= 0) {
    const auto camera = static_cast<std::size_t>(node.camera);
    add_camera(model.cameras[camera], matrix, element("cameras", camera), scene);
  }
  const auto punctual = node.extensions.find("KHR_lights_punctual");
  if (punctual == node.extensions.end() || !punctual->second.IsObject() ||
      !punctual->second.Has("light"))
    return;
  const tinygltf::Value& number = punctual->second.Get("light");
  const double light = number.IsNumber() ? number.GetNumberAsDouble() : -1.0;
  if (!(light >= 0.0 && light < static_cast<double>(model.lights.size())))
    throw unreadable(where + ": KHR_lights_punctual names no light", where);
  const auto at = static_cast<std::size_t>(light);
  add_light(model.lights[at], matrix, element("lights", at), scene);
}

/// Nodes that are no node's child; checks on the way that no child is missing or has two
/// parents.
std::vector<int> root_nodes(const tinygltf::Model& model) {
  std::vector<int> parents(model.nodes.size(), 0), roots;
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    for (const int child : model.nodes[i].children) {
      const std::string where = element("nodes", i, model.nodes[i].name);
      if (child < 0 || static_cast<std::size_t>(child) >= model.nodes.size())
        throw unreadable(where + ".children names no node", where);
      if (++parents[static_cast<std::size_t>(child)] > 1)
        throw unreadable(element("nodes", static_cast<std::size_t>(child)) +
                             " has more than one parent, which glTF forbids",
                         "nodes");
    }
  for (std::size_t i = 0; i < parents.size(); ++i)
    if (parents[i] == 0) roots.push_back(static_cast<int>(i));
  return roots;
}

std::vector<int> scene_nodes(const tinygltf::Model& model, const std::vector<int>& roots) {
  if (model.scenes.empty()) return roots;
  const int chosen = model.defaultScene < 0 ? 0 : model.defaultScene;
  if (static_cast<std::size_t>(chosen) >= model.scenes.size())
    throw unreadable("scene names no scene", "scene");
  const auto& nodes = model.scenes[static_cast<std::size_t>(chosen)].nodes;
  for (const int node : nodes)
    if (node < 0 || static_cast<std::size_t>(node) >= model.nodes.size())
      throw unreadable(element("scenes", static_cast<std::size_t>(chosen)) + ".nodes names no node",
                       "scenes");
  return nodes;
}

}  // namespace

void read_nodes(const tinygltf::Model& model, Scene& scene, Notes& notes) {
  struct Visit {
    int node;
    int depth;
    glm::dmat4 parent;
  };
  std::vector<Visit> open;
  const std::vector<int> starts = scene_nodes(model, root_nodes(model));
  for (auto node = starts.rbegin(); node != starts.rend(); ++node)
    open.push_back({*node, 0, glm::dmat4(1.0)});
  std::vector<bool> seen(model.nodes.size(), false);
  std::size_t corners = 0;
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const auto index = static_cast<std::size_t>(visit.node);
    const tinygltf::Node& node = model.nodes[index];
    const std::string where = element("nodes", index, node.name);
    // Every node has one parent at most, so that only a ring leads here twice.
    if (seen[index]) throw unreadable(where + " is its own ancestor or listed twice", "nodes");
    seen[index] = true;
    if (visit.depth > max_depth)
      throw unreadable(where + " lies deeper than " + std::to_string(max_depth) + " levels",
                       "nodes");
    const glm::dmat4 matrix = visit.parent * local_matrix(node, where);
    for (int column = 0; column < 4; ++column)
      check_finite(std::vector<double>{matrix[column].x, matrix[column].y, matrix[column].z},
                   where);
    add_node(model, node, index, matrix, corners, scene, notes);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      open.push_back({*child, visit.depth + 1, matrix});
  }
  if (!model.animations.empty()) notes.add("", "animations are left out");
}

}  // namespace penumbra::scenes::gltf
