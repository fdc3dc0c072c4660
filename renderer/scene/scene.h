#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "renderer/shaders/shader_types.h"

namespace penumbra {

/// Axis-aligned box in world space, metres. Empty while low > high.
struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Bounds& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  bool empty() const { return low.x > high.x; }
  glm::dvec3 center() const { return 0.5 * (low + high); }
  glm::dvec3 size() const { return high - low; }
  double radius() const { return empty() ? 0.0 : 0.5 * glm::length(high - low); }
};

/// Box around boxes.
inline Bounds around(const std::vector<Bounds>& boxes) {
  Bounds all;
  for (const Bounds& box : boxes) all.add(box);
  return all;
}

/// Colour picture, sRGB-encoded RGBA, row 0 on top (v = 0).
struct Texture {
  std::string name;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;  ///< width * height * 4
};

enum class AlphaMode { opaque, mask };

/// Blinn-Phong material in linear light. Texture and vertex colour multiply `base_color`.
struct Material {
  std::string name;
  glm::vec3 base_color{0.8f};
  glm::vec3 emissive{0.0f};
  float alpha = 1.0f;
  float specular = 0.04f;   ///< reflectance of the highlight, 0..1
  float shininess = 32.0f;  ///< Blinn-Phong exponent, 1..1024
  int texture = -1;         ///< index into Scene::textures, -1 for none
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;  ///< texels below it are holes when alpha_mode is mask
  bool double_sided = false;
};

/// Triangles [first_index, first_index + index_count) of one material.
struct Primitive {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::uint32_t material = 0;
};

/// Indexed triangles in object space, counter-clockwise seen from outside.
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< per vertex, unit; same length as positions
  std::vector<glm::vec2> uvs;      ///< per vertex, or empty; texture transforms already applied
  std::vector<glm::vec4> colors;   ///< per vertex, linear RGBA, or empty
  std::vector<std::uint32_t> indices;
  std::vector<Primitive> primitives;
};

struct Instance {
  std::string name;
  std::uint32_t mesh = 0;
  glm::dmat4 world_from_object{1.0};  ///< may mirror (negative determinant)
  bool casts_shadow = true;
};

/// What only light.h and light.glsl ask about.
enum class LightKind {
  spot = shader::light_kind_spot,
  directional = shader::light_kind_directional,
  point = shader::light_kind_point
};
enum class ExtentKind {
  none = shader::extent_kind_none,
  sphere = shader::extent_kind_sphere,
  disc = shader::extent_kind_disc,
  rectangle = shader::extent_kind_rectangle
};

/// What makes a light cast penumbrae. For directional lights sizes are degrees of angle as seen
/// from the scene (the sun: disc, 0.53), for the others metres.
struct LightExtent {
  ExtentKind kind = ExtentKind::none;
  double radius = 0.0;   ///< sphere, disc. Directional: half the angular diameter, degrees
  glm::dvec2 size{0.0};  ///< rectangle: full width (along `right`) and height. Directional: degrees
};

enum class Attenuation { none, inverse_square };

struct Light {
  std::string name;
  LightKind kind = LightKind::spot;
  glm::dvec3 position{0.0};              ///< centre of the extent; unused when directional
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< from the light into the scene, unit
  glm::dvec3 up{0.0, 0.0, 1.0};          ///< orients a rectangle; any vector not along direction
  glm::vec3 color{1.0f};                 ///< linear
  float intensity = 1.0f;  ///< radiance factor; with inverse_square, its value at one metre
  Attenuation attenuation = Attenuation::none;
  double inner_angle = 20.0;  ///< spot: half angle of full brightness, degrees
  double outer_angle = 25.0;  ///< spot: half angle where light ends, degrees, < 90
  double range = 0.0;         ///< no light beyond it, metres; 0 means unlimited
  LightExtent extent;
};

enum class Projection { perspective, orthographic };

struct Camera {
  std::string name;
  glm::dvec3 position{0.0, 1.0, 5.0};
  glm::dvec3 target{0.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  Projection projection = Projection::perspective;
  double vertical_fov = 45.0;        ///< degrees, perspective
  double orthographic_height = 2.0;  ///< metres, orthographic
  double near_plane = 0.1;           ///< metres; the far plane is at infinity
};

/// A flat receiver of the planar techniques: a convex polygon, counter-clockwise seen from the side
/// that receives. The plane is that of its first three corners.
struct PlanarReceiver {
  std::string name;
  std::vector<glm::dvec3> corners;
};

/// A rectangle that replaces casters where receivers are projected onto planes (Coleman 2006): it
/// cuts them in half, and dark texels on it stop light.
struct ShadowPlane {
  std::string name;
  glm::dvec3 center{0.0};
  glm::dvec3 right{1.0, 0.0, 0.0};   ///< unit, along the texture's width
  glm::dvec3 up{0.0, 1.0, 0.0};      ///< unit, across right, along the texture's height
  glm::dvec2 size{1.0};              ///< metres along right and up
  std::string texture;               ///< name of a texture; empty: the silhouette of the casters
  std::vector<std::string> casters;  ///< names of instances; empty: all that cast shadows
  Bounds receivers;                  ///< shadows only surfaces within; empty: all
};

/// Everything a picture is made of, in world space: metres, Y up, right-handed, angles in degrees.
struct Scene {
  std::string id;
  std::string title;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  std::vector<Camera> cameras;  ///< at least one; the first is the default
  std::vector<PlanarReceiver> receivers;
  std::vector<ShadowPlane> shadow_planes;
  glm::vec3 ambient{0.08f};          ///< linear, multiplies the base colour
  glm::vec3 background_low{0.5f};    ///< linear, at the horizon and below
  glm::vec3 background_high{0.25f};  ///< linear, straight up
  float exposure = 1.0f;             ///< multiplies linear light before encoding
  std::vector<std::string> notes;    ///< what was assumed or repaired on import
};

/// Box around an instance, from transformed vertices.
Bounds instance_bounds(const Scene& scene, const Instance& instance);

/// Box around all instances.
Bounds world_bounds(const Scene& scene);

/// Index of the named camera, 0 for an empty name. Throws not_found naming the cameras there are.
std::size_t find_camera(const Scene& scene, const std::string& name);

/// Throws bad_value of field `where` unless the camera can draw.
void validate_camera(const Camera& camera, const std::string& where);

/// Checks indices, array lengths, finiteness and ranges of everything the renderer relies on.
/// Throws unreadable naming the element at fault.
void validate(const Scene& scene);

}  // namespace penumbra
