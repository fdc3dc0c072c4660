#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/built_in/built_in.h"
#include "scenes/generators/random.h"
#include "scenes/generators/scene_builder.h"
#include "scenes/generators/silhouette.h"

namespace penumbra::scenes {
namespace {

/// A lens-shaped section of a wing or fin: x of its leading and trailing edge, where it stands
/// along the span, and half its thickness.
struct Section {
  double lead, trail, span, half_thickness;
};

/// Wing over sections of growing span; lies in the plane y = 0 with its span along z.
Solid wing(const std::vector<Section>& sections) {
  std::vector<std::vector<glm::dvec3>> rings;
  for (const Section& s : sections) {
    const double chord = s.lead - s.trail, t = s.half_thickness;
    const glm::dvec2 outline[8] = {{s.lead, 0.0},
                                   {s.lead - 0.15 * chord, 0.8 * t},
                                   {s.lead - 0.40 * chord, t},
                                   {s.lead - 0.70 * chord, 0.6 * t},
                                   {s.trail, 0.0},
                                   {s.lead - 0.70 * chord, -0.6 * t},
                                   {s.lead - 0.40 * chord, -t},
                                   {s.lead - 0.15 * chord, -0.8 * t}};
    std::vector<glm::dvec3> ring;
    for (const glm::dvec2& p : outline) ring.emplace_back(p.x, p.y, s.span);
    rings.push_back(ring);
  }
  return loft(rings);
}

/// Body of ellipses along x: station, height of its middle, half width, half height.
Solid hull(const std::vector<glm::dvec4>& stations, int sides) {
  std::vector<std::vector<glm::dvec3>> rings;
  for (const glm::dvec4& s : stations) {
    std::vector<glm::dvec3> ring;
    for (int i = 0; i < sides; ++i) {
      const glm::dvec2 c = circle(360.0 * i / sides);
      ring.emplace_back(s.x, s.y + s.w * c.y, -s.z * c.x);
    }
    rings.push_back(ring);
  }
  return loft(rings);
}

struct Looks {
  Look skin, dark, glass, metal, rubber;
};

/// Wings and tailplane.
void add_surfaces(Mesh& mesh, const Looks& looks) {
  add_part(mesh,
           wing({{-2.6, -3.1, -4.7, 0.025},
                 {0.9, -3.0, -1.2, 0.07},
                 {1.5, -3.0, 0.0, 0.09},
                 {0.9, -3.0, 1.2, 0.07},
                 {-2.6, -3.1, 4.7, 0.025}}),
           looks.skin, glm::dmat4(1.0), 30.0);
  add_part(mesh,
           wing({{-5.6, -6.1, -2.7, 0.02},
                 {-4.1, -5.9, -0.9, 0.05},
                 {-4.1, -5.9, 0.9, 0.05},
                 {-5.6, -6.1, 2.7, 0.02}}),
           looks.skin, glm::dmat4(1.0), 30.0);
}

/// Fins lean outwards by 18 degrees; a wing's span is turned up.
glm::dmat4 fin_place(double side) {
  return move({0.0, 0.15, 0.85 * side}) * turn_x(-90.0 + 18.0 * side);
}

void add_fins(Mesh& mesh, const Looks& looks) {
  for (const double side : {-1.0, 1.0})
    add_part(mesh, wing({{-3.0, -5.4, 0.0, 0.06}, {-4.7, -5.7, 1.9, 0.025}}), looks.skin,
             fin_place(side), 30.0);
}

void add_body(Mesh& mesh, const Looks& looks) {
  add_part(mesh,
           hull({{-5.6, 0.02, 0.50, 0.46},
                 {-5.0, 0.02, 0.72, 0.60},
                 {-3.0, 0.02, 0.95, 0.68},
                 {-0.5, 0.00, 1.00, 0.66},
                 {1.6, 0.02, 0.85, 0.62},
                 {3.2, 0.00, 0.60, 0.52},
                 {4.6, -0.06, 0.38, 0.36},
                 {5.7, -0.14, 0.16, 0.15},
                 {6.2, -0.18, 0.02, 0.02}},
                24),
           looks.skin, glm::dmat4(1.0), 30.0);
  add_part(mesh, hull({{-6.15, 0.02, 0.34, 0.34}, {-5.5, 0.02, 0.46, 0.44}}, 24), looks.dark,
           glm::dmat4(1.0), 30.0);
  add_part(mesh,
           hull({{0.9, 0.50, 0.10, 0.08},
                 {1.6, 0.52, 0.32, 0.38},
                 {2.6, 0.44, 0.38, 0.48},
                 {3.4, 0.34, 0.30, 0.36},
                 {4.1, 0.22, 0.08, 0.10}},
                20),
           looks.glass);
  for (const double side : {-1.0, 1.0})
    add_part(
        mesh,
        hull({{-1.2, -0.12, 0.30, 0.42}, {1.4, -0.10, 0.32, 0.42}, {2.1, -0.10, 0.26, 0.34}}, 12),
        looks.skin, move({0.0, 0.0, 0.92 * side}), 30.0);
  for (const double side : {-1.0, 1.0})
    add_part(mesh,
             hull({{-0.8, 0.0, 0.02, 0.02},
                   {-0.5, 0.0, 0.09, 0.09},
                   {0.7, 0.0, 0.09, 0.09},
                   {1.2, 0.0, 0.01, 0.01}},
                  12),
             looks.metal, move({-1.2, -0.30, 2.7 * side}), 30.0);
}

void add_gear(Mesh& mesh, const Looks& looks) {
  const glm::dvec3 feet[3] = {{3.3, -1.45, 0.0}, {-1.6, -1.40, -1.05}, {-1.6, -1.40, 1.05}};
  for (const glm::dvec3& foot : feet) {
    const double radius = foot.z == 0.0 ? 0.25 : 0.30;
    add_part(mesh, cylinder(0.055, 0.055, 1.2, 12), looks.metal, move({foot.x, foot.y, foot.z}));
    add_part(mesh, cylinder(radius, radius, 0.20, 20), looks.rubber,
             move({foot.x, -1.70 + radius, foot.z - 0.10}) * turn_x(90.0));
  }
}

/// Coleman's planes: one that cuts wings, tailplane and fuselage into an upper and a lower half,
/// and one for each fin, which share a texture (2006, 5). The fin's reaches down into the fuselage,
/// so that its shadow reaches the fin's root.
void add_shadow_planes(Scene& scene, const Looks& looks, const glm::dmat4& jet) {
  Mesh flat, fin;
  add_surfaces(flat, looks);
  add_body(flat, looks);
  add_part(fin,
           wing({{-2.6, -5.33, -0.45, 0.06}, {-3.0, -5.4, 0.0, 0.06}, {-4.7, -5.7, 1.9, 0.025}}),
           looks.skin);
  ShadowPlane level;
  level.name = "wings and fuselage";
  level.right = {1.0, 0.0, 0.0};
  level.up = {0.0, 0.0, -1.0};
  level.size = {12.8, 9.8};
  level.texture = "wings and fuselage";
  scene.textures.push_back(silhouette_texture(level.texture, flat, level, 512));
  ShadowPlane upright;
  upright.center = {-4.15, 0.0, 0.75};
  upright.right = {1.0, 0.0, 0.0};
  upright.up = {0.0, 0.0, 1.0};
  upright.size = {3.4, 2.6};
  upright.texture = "fin";
  scene.textures.push_back(silhouette_texture(upright.texture, fin, upright, 256));
  scene.shadow_planes.push_back(moved_plane(level, jet));
  for (const double side : {-1.0, 1.0}) {
    upright.name = side < 0.0 ? "left fin" : "right fin";
    scene.shadow_planes.push_back(moved_plane(upright, jet * fin_place(side)));
  }
}

}  // namespace

/// A jet of flat parts that stands on an apron under a high sun: wings, tailplanes and fins shadow
/// the body and each other.
Scene make_aircraft() {
  SceneBuilder b("aircraft", "A jet on an apron");
  const Look apron = b.look("apron", {0.74f, 0.74f, 0.72f}, b.texture("concrete", 81), 5.0);
  const int paint = b.texture("painted_metal", 82);
  const Looks looks = {b.look("skin", {0.50f, 0.54f, 0.58f}, paint, 2.0, 0.08f, 50.0f),
                       b.look("nozzle", glm::vec3(0.10f), -1, 1.0, 0.10f, 30.0f),
                       b.look("canopy", {0.06f, 0.08f, 0.10f}, -1, 1.0, 0.30f, 300.0f),
                       b.look("metal", {0.60f, 0.61f, 0.62f}, -1, 1.0, 0.20f, 80.0f),
                       b.look("rubber", glm::vec3(0.05f), -1, 1.0, 0.04f, 16.0f)};
  b.ground({-24.0, -24.0}, {24.0, 24.0}, apron);
  Mesh mesh;
  add_surfaces(mesh, looks);
  add_fins(mesh, looks);
  add_body(mesh, looks);
  add_gear(mesh, looks);
  const glm::dmat4 place = move({0.0, 1.70, 0.0}) * turn_y(22.0);
  b.place(b.add_mesh("jet", std::move(mesh)), place, "jet");
  add_shadow_planes(b.scene, looks, place);
  b.spot("sun", {-14.0, 30.0, 13.0}, {0.0, 1.0, 0.0}, {1.0f, 0.95f, 0.86f}, 1.25f, 32.0, disc(0.25))
      .inner_angle = 24.0;
  b.camera("main", {-9.2, 7.0, 11.6}, {-0.6, 1.1, 0.9}, 48.0);
  b.camera("above", {-3.0, 15.0, 6.0}, {0.0, 1.5, 0.0}, 45.0);
  b.scene.ambient = {0.16f, 0.18f, 0.21f};
  b.scene.background_low = {0.62f, 0.70f, 0.78f};
  b.scene.background_high = {0.22f, 0.38f, 0.62f};
  return std::move(b.scene);
}

Scene make_fleet(int count) {
  Scene scene = make_aircraft();
  scene.id = "fleet:" + std::to_string(count);
  scene.title = std::to_string(count) + " jets on an apron";
  // Planes are generated once for all copies of a mesh.
  scene.shadow_planes.clear();
  const Instance jet = scene.instances.back();
  scene.instances.pop_back();
  const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
  const double spacing = 26.0 / columns;
  const double scale = std::min(1.0, spacing / 11.0);
  const glm::dmat4 smaller = glm::scale(glm::dmat4(1.0), glm::dvec3(scale));
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 place((i % columns - 0.5 * (columns - 1)) * spacing, 0.0,
                           (i / columns - 0.5 * (columns - 1)) * spacing);
    Instance instance = jet;
    instance.name = "jet " + std::to_string(i);
    instance.world_from_object = move(place) * turn_y(137.5 * i) * smaller * jet.world_from_object;
    scene.instances.push_back(instance);
  }
  scene.cameras.front().position = {-16.0, 20.0, 26.0};
  return scene;
}

Scene make_named_fleet(const std::string& name) {
  const Error error =
      bad_value("scene", "'" + name + "' is no fleet: fleet:<aircraft 1..400>, such as fleet:20");
  const int count = numbers_of(name, "fleet:", 1, error).front();
  if (count < 1 || count > 400) throw error;
  return make_fleet(count);
}

}  // namespace penumbra::scenes
