#include <cmath>

#include "renderer/scene/light.h"
#include "scenes/document.h"
#include "scenes/json_reader.h"
#include "scenes/json_text.h"

namespace penumbra::scenes {
namespace {

using nlohmann::json;

const std::vector<std::pair<const char*, Attenuation>> attenuations = {
    {"none", Attenuation::none}, {"inverse_square", Attenuation::inverse_square}};
const std::vector<std::pair<const char*, Projection>> projections = {
    {"perspective", Projection::perspective}, {"orthographic", Projection::orthographic}};
const std::vector<std::pair<const char*, AlphaMode>> alpha_modes = {{"opaque", AlphaMode::opaque},
                                                                    {"mask", AlphaMode::mask}};

template <class T>
json name_of(const std::vector<std::pair<const char*, T>>& choices, T value) {
  for (const auto& [name, choice] : choices)
    if (choice == value) return name;
  throw unreadable("a value that has no name");
}

bool independent(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::length(glm::cross(a, b)) > 1e-6 * glm::length(a) * glm::length(b);
}

void read_extent(const json& value, const std::string& path, LightExtent& extent) {
  JsonReader reader(value, path);
  reader.choice("kind", extent.kind, extent_kinds());
  reader.number("radius", extent.radius, 0.0, 1e9);
  reader.vector("size", extent.size, 0.0, 1e9);
  reader.finish();
}

}  // namespace

json write_light(const Light& light) {
  return {{"name", light.name},
          {"kind", name_of(light_kinds(), light.kind)},
          {"position", json_list(light.position)},
          {"direction", json_list(light.direction)},
          {"up", json_list(light.up)},
          {"color", json_list(light.color)},
          {"intensity", light.intensity},
          {"attenuation", name_of(attenuations, light.attenuation)},
          {"inner_angle", light.inner_angle},
          {"outer_angle", light.outer_angle},
          {"range", light.range},
          {"extent",
           {{"kind", name_of(extent_kinds(), light.extent.kind)},
            {"radius", light.extent.radius},
            {"size", json_list(light.extent.size)}}}};
}

void read_light(const json& value, const std::string& path, Light& light) {
  JsonReader reader(value, path);
  reader.text("name", light.name);
  reader.choice("kind", light.kind, light_kinds());
  reader.vector("position", light.position, -max_coordinate, max_coordinate);
  if (reader.has("direction") && reader.has("target"))
    reader.fail("target", "and direction exclude each other");
  glm::dvec3 direction = light.direction;
  reader.vector("direction", direction, -max_coordinate, max_coordinate);
  if (reader.has("target")) {
    glm::dvec3 target(0.0);
    reader.vector("target", target, -max_coordinate, max_coordinate);
    direction = target - light.position;
  }
  const double length = glm::length(direction);
  if (length == 0.0) reader.fail("direction", "must not be zero");
  // A unit vector stays what it is, so that a written scene reads back the same.
  light.direction = std::abs(length - 1.0) < 1e-12 ? direction : direction / length;
  reader.vector("up", light.up, -max_coordinate, max_coordinate);
  if (!independent(light.direction, light.up)) {
    if (value.contains("up")) reader.fail("up", "must not lie along direction");
    light.up = std::abs(light.direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  }
  reader.color("color", light.color);
  reader.number("intensity", light.intensity, 0.0, max_intensity);
  reader.choice("attenuation", light.attenuation, attenuations);
  reader.number("outer_angle", light.outer_angle, 1e-3, 89.9);
  light.inner_angle = std::min(light.inner_angle, light.outer_angle);
  reader.number("inner_angle", light.inner_angle, 0.0, 89.9);
  if (light.inner_angle > light.outer_angle)
    reader.fail("inner_angle", "must not be above outer_angle");
  reader.number("range", light.range, 0.0, max_coordinate);
  if (reader.has("extent"))
    read_extent(reader.at("extent"), reader.path_of("extent"), light.extent);
  if (!is_extent_valid(light))
    reader.fail("extent", "of a directional light is in degrees and stays within half of the sky");
  reader.finish();
}

json write_camera(const Camera& camera) {
  return {{"name", camera.name},
          {"position", json_list(camera.position)},
          {"target", json_list(camera.target)},
          {"up", json_list(camera.up)},
          {"projection", name_of(projections, camera.projection)},
          {"vertical_fov", camera.vertical_fov},
          {"orthographic_height", camera.orthographic_height},
          {"near_plane", camera.near_plane}};
}

void read_camera(const json& value, const std::string& path, Camera& camera) {
  JsonReader reader(value, path);
  reader.text("name", camera.name);
  reader.vector("position", camera.position, -max_coordinate, max_coordinate);
  if (reader.has("direction") && reader.has("target"))
    reader.fail("direction", "and target exclude each other");
  reader.vector("target", camera.target, -max_coordinate, max_coordinate);
  if (reader.has("direction")) {
    glm::dvec3 direction(0.0);
    reader.vector("direction", direction, -max_coordinate, max_coordinate);
    if (direction == glm::dvec3(0.0)) reader.fail("direction", "must not be zero");
    camera.target = camera.position + direction;
  }
  reader.vector("up", camera.up, -max_coordinate, max_coordinate);
  if (!independent(camera.target - camera.position, camera.up))
    reader.fail("up", "must not lie along the line of sight");
  reader.choice("projection", camera.projection, projections);
  if (reader.has("vertical_fov") && reader.has("field_of_view"))
    reader.fail("field_of_view", "and vertical_fov are two names of one angle");
  for (const char* name : {"vertical_fov", "field_of_view"})
    reader.number(name, camera.vertical_fov, 0.01, 179.99);
  reader.number("orthographic_height", camera.orthographic_height, 1e-9, max_coordinate);
  reader.number("near_plane", camera.near_plane, 1e-9, max_coordinate);
  reader.finish();
}

json write_material(const Material& material) {
  json value = {{"name", material.name},
                {"base_color", json_list(material.base_color)},
                {"emissive", json_list(material.emissive)},
                {"alpha", material.alpha},
                {"specular", material.specular},
                {"shininess", material.shininess},
                {"alpha_mode", name_of(alpha_modes, material.alpha_mode)},
                {"alpha_cutoff", material.alpha_cutoff},
                {"double_sided", material.double_sided}};
  if (material.texture >= 0) value["texture"] = material.texture;
  return value;
}

void read_material(const json& value, const std::string& path, Material& material) {
  JsonReader reader(value, path);
  reader.text("name", material.name);
  reader.color("base_color", material.base_color);
  reader.color("emissive", material.emissive);
  reader.number("alpha", material.alpha, 0.0, 1.0);
  reader.number("specular", material.specular, 0.0, 1.0);
  reader.number("shininess", material.shininess, 1.0, 1024.0);
  std::int64_t texture = material.texture;
  reader.integer("texture", texture, -1, 1 << 20);
  material.texture = static_cast<int>(texture);
  reader.choice("alpha_mode", material.alpha_mode, alpha_modes);
  reader.number("alpha_cutoff", material.alpha_cutoff, 0.0, 1.0);
  reader.boolean("double_sided", material.double_sided);
  reader.finish();
}

namespace {

json write_shadow_plane(const ShadowPlane& plane) {
  json value = {{"name", plane.name},
                {"center", json_list(plane.center)},
                {"right", json_list(plane.right)},
                {"up", json_list(plane.up)},
                {"size", {plane.size.x, plane.size.y}}};
  if (!plane.texture.empty()) value["texture"] = plane.texture;
  if (!plane.casters.empty()) value["casters"] = plane.casters;
  if (!plane.receivers.empty())
    value["receivers"] = {{"low", json_list(plane.receivers.low)},
                          {"high", json_list(plane.receivers.high)}};
  return value;
}

ShadowPlane read_shadow_plane(const json& value, const std::string& where) {
  JsonReader entry(value, where);
  ShadowPlane plane;
  entry.text("name", plane.name);
  entry.vector("center", plane.center, -max_coordinate, max_coordinate);
  entry.vector("right", plane.right, -1.0, 1.0);
  entry.vector("up", plane.up, -1.0, 1.0);
  entry.vector("size", plane.size, 1e-9, max_coordinate);
  entry.text("texture", plane.texture);
  if (entry.has("casters")) {
    const json& casters = entry.at("casters");
    if (!casters.is_array()) entry.fail("casters", "must be a list of names");
    for (const json& caster : casters) {
      if (!caster.is_string()) entry.fail("casters", "must be a list of names");
      plane.casters.push_back(caster.get<std::string>());
    }
  }
  if (entry.has("receivers")) {
    JsonReader box(entry.at("receivers"), where + ".receivers");
    glm::dvec3 low(0.0), high(0.0);
    box.at("low");
    box.at("high");
    box.vector("low", low, -max_coordinate, max_coordinate);
    box.vector("high", high, -max_coordinate, max_coordinate);
    box.finish();
    plane.receivers.add(low);
    plane.receivers.add(high);
  }
  entry.finish();
  return plane;
}

}  // namespace

json write_surroundings(const Scene& scene) {
  json receivers = json::array();
  for (const PlanarReceiver& receiver : scene.receivers) {
    json corners = json::array();
    for (const glm::dvec3& corner : receiver.corners) corners.push_back(json_list(corner));
    receivers.push_back({{"name", receiver.name}, {"corners", corners}});
  }
  json value = {{"receivers", receivers},
                {"ambient", json_list(scene.ambient)},
                {"background_low", json_list(scene.background_low)},
                {"background_high", json_list(scene.background_high)},
                {"exposure", scene.exposure}};
  for (const ShadowPlane& plane : scene.shadow_planes)
    value["shadow_planes"].push_back(write_shadow_plane(plane));
  return value;
}

void read_surroundings(const json& value, const std::string& path, Scene& scene) {
  JsonReader reader(value, path);
  reader.color("ambient", scene.ambient);
  reader.color("background_low", scene.background_low);
  reader.color("background_high", scene.background_high);
  reader.number("exposure", scene.exposure, 1e-9, 1e9);
  if (reader.has("receivers")) {
    if (!reader.at("receivers").is_array()) reader.fail("receivers", "must be a list");
    for (std::size_t i = 0; i < reader.at("receivers").size(); ++i) {
      const std::string where = reader.path_of("receivers") + "[" + std::to_string(i) + "]";
      JsonReader entry(reader.at("receivers")[i], where);
      PlanarReceiver receiver;
      entry.text("name", receiver.name);
      const json& corners = entry.at("corners");
      if (!corners.is_array()) entry.fail("corners", "must be a list");
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const std::string corner_path = where + ".corners[" + std::to_string(k) + "]";
        const auto n = read_numbers(corners[k], corner_path, -max_coordinate, max_coordinate);
        if (n.size() != 3) throw unreadable(corner_path + " must have three numbers", corner_path);
        receiver.corners.emplace_back(n[0], n[1], n[2]);
      }
      entry.finish();
      scene.receivers.push_back(std::move(receiver));
    }
  }
  if (reader.has("shadow_planes")) {
    if (!reader.at("shadow_planes").is_array()) reader.fail("shadow_planes", "must be a list");
    for (std::size_t i = 0; i < reader.at("shadow_planes").size(); ++i)
      scene.shadow_planes.push_back(
          read_shadow_plane(reader.at("shadow_planes")[i],
                            reader.path_of("shadow_planes") + "[" + std::to_string(i) + "]"));
  }
  reader.finish();
}

}  // namespace penumbra::scenes
