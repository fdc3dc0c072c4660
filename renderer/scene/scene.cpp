#include "renderer/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "renderer/error.h"
#include "renderer/scene/light.h"

namespace penumbra {
namespace {

/// Largest side of a texture: what every Vulkan device must accept is 4096, what they do is 16384.
constexpr std::uint32_t max_texture_size = 16384;

std::string element(const char* list, std::size_t index, const std::string& name) {
  std::string text = std::string(list) + "[" + std::to_string(index) + "]";
  return name.empty() ? text : text + " '" + name + "'";
}

void check(bool holds, const std::string& where, const char* what) {
  if (!holds) throw unreadable(where + ": " + what);
}

bool finite(double value) {
  return std::isfinite(value);
}

template <int N, class T>
bool finite(const glm::vec<N, T>& value) {
  for (int i = 0; i < N; ++i)
    if (!std::isfinite(value[i])) return false;
  return true;
}

bool positive_color(const glm::vec3& color) {
  return finite(color) && color.x >= 0.0f && color.y >= 0.0f && color.z >= 0.0f;
}

/// Whether two directions span a plane: neither is zero and they are not parallel.
bool independent(const glm::dvec3& a, const glm::dvec3& b) {
  const double lengths = glm::length(a) * glm::length(b);
  return lengths > 0.0 && glm::length(glm::cross(a, b)) > 1e-6 * lengths;
}

void validate_texture(const Texture& texture, const std::string& where) {
  check(texture.width > 0 && texture.height > 0, where, "has no texels");
  check(texture.width <= max_texture_size && texture.height <= max_texture_size, where,
        "is wider or higher than 16384 texels");
  check(texture.rgba.size() == std::size_t{texture.width} * texture.height * 4, where,
        "rgba must hold width * height * 4 bytes");
}

void validate_material(const Material& material, std::size_t textures, const std::string& where) {
  check(positive_color(material.base_color), where, "base_color must be finite and >= 0");
  check(positive_color(material.emissive), where, "emissive must be finite and >= 0");
  check(material.alpha >= 0.0f && material.alpha <= 1.0f, where, "alpha must be in 0..1");
  check(material.specular >= 0.0f && material.specular <= 1.0f, where, "specular must be in 0..1");
  check(material.shininess >= 1.0f && material.shininess <= 1024.0f, where,
        "shininess must be in 1..1024");
  check(material.alpha_cutoff >= 0.0f && material.alpha_cutoff <= 1.0f, where,
        "alpha_cutoff must be in 0..1");
  check(material.texture >= -1 && material.texture < static_cast<int>(textures), where,
        "texture names no texture");
}

void validate_mesh(const Mesh& mesh, std::size_t materials, const std::string& where) {
  const std::size_t vertices = mesh.positions.size();
  check(mesh.normals.size() == vertices, where, "needs one normal per position");
  check(mesh.uvs.empty() || mesh.uvs.size() == vertices, where, "needs one uv per position");
  check(mesh.colors.empty() || mesh.colors.size() == vertices, where,
        "needs one color per position");
  for (const glm::vec3& position : mesh.positions)
    check(finite(position), where, "has a position that is not finite");
  for (const glm::vec3& normal : mesh.normals) {
    const float squared = glm::dot(normal, normal);
    check(squared > 0.98f && squared < 1.02f, where, "has a normal that is not a unit vector");
  }
  for (const glm::vec2& uv : mesh.uvs) check(finite(uv), where, "has a uv that is not finite");
  for (const glm::vec4& color : mesh.colors)
    check(finite(color), where, "has a color that is not finite");
  check(mesh.indices.size() % 3 == 0, where, "has indices of an incomplete triangle");
  for (const std::uint32_t index : mesh.indices)
    check(index < vertices, where, "has an index beyond its positions");
  for (const Primitive& primitive : mesh.primitives) {
    check(primitive.index_count % 3 == 0, where, "has a primitive of incomplete triangles");
    check(std::uint64_t{primitive.first_index} + primitive.index_count <= mesh.indices.size(),
          where, "has a primitive beyond its indices");
    check(primitive.material < materials, where, "has a primitive of no material");
  }
}

void validate_instance(const Instance& instance, std::size_t meshes, const std::string& where) {
  check(instance.mesh < meshes, where, "mesh names no mesh");
  const glm::dmat4& matrix = instance.world_from_object;
  for (int column = 0; column < 4; ++column)
    check(finite(matrix[column]), where, "world_from_object is not finite");
  check(matrix[0].w == 0.0 && matrix[1].w == 0.0 && matrix[2].w == 0.0 && matrix[3].w == 1.0, where,
        "world_from_object must be affine");
  const double determinant = glm::determinant(glm::dmat3(matrix));
  check(finite(determinant) && determinant != 0.0, where, "world_from_object has no inverse");
}

void validate_light(const Light& light, const std::string& where) {
  check(finite(light.position), where, "position is not finite");
  check(finite(light.direction) && std::abs(glm::length(light.direction) - 1.0) < 1e-6, where,
        "direction must be a unit vector");
  check(finite(light.up) && independent(light.direction, light.up), where,
        "up must not lie along direction");
  check(positive_color(light.color), where, "color must be finite and >= 0");
  check(std::isfinite(light.intensity) && light.intensity >= 0.0f, where,
        "intensity must be finite and >= 0");
  check(light.inner_angle >= 0.0 && light.inner_angle <= light.outer_angle, where,
        "inner_angle must be in 0..outer_angle");
  check(light.outer_angle > 0.0 && light.outer_angle < 90.0, where,
        "outer_angle must be above 0 and below 90");
  check(finite(light.range) && light.range >= 0.0, where, "range must be finite and >= 0");
  const LightExtent& extent = light.extent;
  check(finite(extent.radius) && extent.radius >= 0.0, where,
        "extent.radius must be finite and >= 0");
  check(finite(extent.size) && extent.size.x >= 0.0 && extent.size.y >= 0.0, where,
        "extent.size must be finite and >= 0");
  check(is_extent_valid(light), where,
        "extent of a directional light must stay within its half of the sky");
}

void validate_shadow_plane(const Scene& scene, const ShadowPlane& plane, const std::string& where) {
  check(finite(plane.center) && finite(plane.right) && finite(plane.up), where,
        "has a vector that is not finite");
  check(std::abs(glm::length(plane.right) - 1.0) < 1e-6 &&
            std::abs(glm::length(plane.up) - 1.0) < 1e-6 &&
            std::abs(glm::dot(plane.right, plane.up)) < 1e-6,
        where, "right and up must be unit vectors across each other");
  check(std::isfinite(plane.size.x) && std::isfinite(plane.size.y) && plane.size.x > 0.0 &&
            plane.size.y > 0.0,
        where, "its size must be above 0");
  check(plane.texture.empty() ||
            std::any_of(scene.textures.begin(), scene.textures.end(),
                        [&](const Texture& texture) { return texture.name == plane.texture; }),
        where, "names a texture that the scene has not");
  for (const std::string& caster : plane.casters)
    check(std::any_of(scene.instances.begin(), scene.instances.end(),
                      [&](const Instance& instance) { return instance.name == caster; }),
          where, "names a caster that is no instance of the scene");
  if (!plane.receivers.empty())
    check(finite(plane.receivers.low) && finite(plane.receivers.high), where,
          "its receivers' box is not finite");
}

void validate_receiver(const PlanarReceiver& receiver, const std::string& where) {
  const auto& corners = receiver.corners;
  check(corners.size() >= 3, where, "needs at least three corners");
  Bounds bounds;
  for (const glm::dvec3& corner : corners) {
    check(finite(corner), where, "has a corner that is not finite");
    bounds.add(corner);
  }
  check(independent(corners[1] - corners[0], corners[2] - corners[0]), where,
        "its first three corners lie on a line");
  const glm::dvec3 normal =
      glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double tolerance = 1e-5 * bounds.radius();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3& a = corners[i];
    const glm::dvec3& b = corners[(i + 1) % corners.size()];
    const glm::dvec3& c = corners[(i + 2) % corners.size()];
    check(std::abs(glm::dot(a - corners[0], normal)) <= tolerance, where, "is not flat");
    check(glm::dot(glm::cross(b - a, c - b), normal) >= -tolerance * tolerance, where,
          "is not convex");
  }
}

/// Lights and cameras are addressed by name, so that names must be there and differ.
template <class T>
void validate_names(const std::vector<T>& list, const char* kind) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    check(!list[i].name.empty(), element(kind, i, ""), "needs a name");
    check(seen.insert(list[i].name).second, element(kind, i, list[i].name),
          "has a name that another one has");
  }
}

}  // namespace

Bounds instance_bounds(const Scene& scene, const Instance& instance) {
  Bounds bounds;
  for (const glm::vec3& position : scene.meshes.at(instance.mesh).positions)
    bounds.add(glm::dvec3(instance.world_from_object * glm::dvec4(glm::dvec3(position), 1.0)));
  return bounds;
}

Bounds world_bounds(const Scene& scene) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) bounds.add(instance_bounds(scene, instance));
  return bounds;
}

void validate_camera(const Camera& camera, const std::string& where) {
  check(finite(camera.position) && finite(camera.target) && finite(camera.up), where,
        "position, target and up must be finite");
  check(independent(camera.target - camera.position, camera.up), where,
        "up must not lie along the line of sight, and target must not be the position");
  check(camera.vertical_fov > 0.0 && camera.vertical_fov < 180.0, where,
        "vertical_fov must be above 0 and below 180");
  check(finite(camera.orthographic_height) && camera.orthographic_height > 0.0, where,
        "orthographic_height must be above 0");
  check(finite(camera.near_plane) && camera.near_plane > 0.0, where, "near_plane must be above 0");
}

std::size_t find_camera(const Scene& scene, const std::string& name) {
  if (name.empty() && !scene.cameras.empty()) return 0;
  std::string names;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    if (scene.cameras[i].name == name) return i;
    names += (i == 0 ? "" : ", ") + scene.cameras[i].name;
  }
  throw not_found("camera", "no camera '" + name + "' in scene '" + scene.id +
                                "'; there are: " + (names.empty() ? "none" : names));
}

void validate(const Scene& scene) {
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    validate_texture(scene.textures[i], element("textures", i, scene.textures[i].name));
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    validate_material(scene.materials[i], scene.textures.size(),
                      element("materials", i, scene.materials[i].name));
  for (std::size_t i = 0; i < scene.meshes.size(); ++i)
    validate_mesh(scene.meshes[i], scene.materials.size(),
                  element("meshes", i, scene.meshes[i].name));
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    validate_instance(scene.instances[i], scene.meshes.size(),
                      element("instances", i, scene.instances[i].name));
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    validate_light(scene.lights[i], element("lights", i, scene.lights[i].name));
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    validate_camera(scene.cameras[i], element("cameras", i, scene.cameras[i].name));
  for (std::size_t i = 0; i < scene.receivers.size(); ++i)
    validate_receiver(scene.receivers[i], element("receivers", i, scene.receivers[i].name));
  for (std::size_t i = 0; i < scene.shadow_planes.size(); ++i)
    validate_shadow_plane(scene, scene.shadow_planes[i],
                          element("shadow_planes", i, scene.shadow_planes[i].name));
  validate_names(scene.lights, "lights");
  validate_names(scene.cameras, "cameras");
  check(!scene.cameras.empty(), "cameras", "a scene needs at least one");
  check(positive_color(scene.ambient), "ambient", "must be finite and >= 0");
  check(positive_color(scene.background_low), "background_low", "must be finite and >= 0");
  check(positive_color(scene.background_high), "background_high", "must be finite and >= 0");
  check(std::isfinite(scene.exposure) && scene.exposure > 0.0f, "exposure", "must be above 0");
}

}  // namespace penumbra
