#include "scenes/built_in/built_in.h"
#include "scenes/generators/random.h"
#include "scenes/generators/scene_builder.h"
#include "scenes/generators/silhouette.h"

namespace penumbra::scenes {
namespace {

/// Points of a smooth curve through the given ones (Catmull and Rom 1974), `steps` to each piece.
std::vector<glm::dvec3> curve(const std::vector<glm::dvec3>& through, int steps) {
  std::vector<glm::dvec3> points;
  const auto at = [&](std::size_t i, int by) {
    const auto k = static_cast<std::ptrdiff_t>(i) + by;
    const auto last = static_cast<std::ptrdiff_t>(through.size()) - 1;
    return through[static_cast<std::size_t>(std::min(std::max<std::ptrdiff_t>(k, 0), last))];
  };
  for (std::size_t i = 0; i + 1 < through.size(); ++i)
    for (int step = 0; step < steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      const glm::dvec3 a = at(i, -1), b = at(i, 0), c = at(i, 1), d = at(i, 2);
      points.push_back(0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t +
                              (3.0 * (b - c) + d - a) * t * t * t));
    }
  points.push_back(through.back());
  return points;
}

std::vector<glm::dvec2> profile(const std::vector<glm::dvec2>& through, int steps) {
  std::vector<glm::dvec3> points;
  for (const glm::dvec2& p : through) points.emplace_back(p, 0.0);
  std::vector<glm::dvec2> result;
  for (const glm::dvec3& p : curve(points, steps)) result.emplace_back(std::max(p.x, 0.0), p.y);
  return result;
}

/// Radii that go evenly from one value to another.
std::vector<double> between(double first, double last, std::size_t count) {
  std::vector<double> radii;
  for (std::size_t i = 0; i < count; ++i)
    radii.push_back(first +
                    (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
  return radii;
}

struct PotLooks {
  Look glaze, rim;
};

std::vector<glm::dvec3> spout_path() {
  return curve({{0.85, 0.50, 0.0},
                {1.22, 0.62, 0.0},
                {1.44, 0.98, 0.0},
                {1.62, 1.32, 0.0},
                {1.86, 1.46, 0.0}},
               6);
}

std::vector<glm::dvec3> handle_path() {
  return curve({{-0.80, 1.24, 0.0},
                {-1.22, 1.34, 0.0},
                {-1.62, 1.18, 0.0},
                {-1.60, 0.76, 0.0},
                {-1.28, 0.46, 0.0},
                {-0.92, 0.40, 0.0}},
               6);
}

constexpr double handle_radius = 0.095;
constexpr double waist_radius = 1.12, waist_height = 0.78;
constexpr double knob_radius = 0.12, knob_height = 1.78;
constexpr double spout_tip_radius = 0.10;

void add_pot(Mesh& mesh, const PotLooks& looks) {
  add_part(mesh,
           lathe(profile({{0.62, 0.02},
                          {0.70, 0.08},
                          {1.02, 0.42},
                          {waist_radius, waist_height},
                          {1.00, 1.14},
                          {0.74, 1.38},
                          {0.66, 1.44}},
                         6),
                 64),
           looks.glaze, glm::dmat4(1.0), 50.0);
  add_part(mesh, torus(0.665, 0.035, 64, 12), looks.rim, move({0.0, 1.44, 0.0}), 60.0);
}

/// Lid and knob.
void add_top(Mesh& mesh, const PotLooks& looks) {
  add_part(
      mesh,
      lathe(profile({{0.62, 1.43}, {0.60, 1.49}, {0.42, 1.58}, {0.16, 1.64}, {0.07, 1.68}}, 5), 48),
      looks.glaze, glm::dmat4(1.0), 50.0);
  add_part(mesh, sphere(knob_radius, 32, 16), looks.rim, move({0.0, knob_height, 0.0}), 60.0);
}

void add_spout(Mesh& mesh, const PotLooks& looks) {
  const auto path = spout_path();
  add_part(mesh, tube(path, between(0.25, spout_tip_radius, path.size()), 24), looks.glaze,
           glm::dmat4(1.0), 60.0);
}

void add_handle(Mesh& mesh, const PotLooks& looks) {
  const auto path = handle_path();
  add_part(mesh, tube(path, std::vector<double>(path.size(), handle_radius), 20), looks.glaze,
           glm::dmat4(1.0), 60.0);
}

ShadowPlane pot_plane(const std::string& name, const glm::dvec3& center, const glm::dvec3& right,
                      const glm::dvec3& up, const glm::dvec2& size, const std::string& texture) {
  ShadowPlane plane;
  plane.name = name;
  plane.center = center;
  plane.right = glm::normalize(right);
  plane.up = glm::normalize(up);
  plane.size = size;
  plane.texture = texture;
  return plane;
}

/// Coleman's planes (2006, 5): three through the top, of which two stand upright and share a
/// texture; along the spout its profile from the side and from above, and a cap at its tip; and
/// five rectangles end to end along the handle, dark all over. His pot shadowed itself alone; this
/// one stands on a table, for which its body has three more, through its middle and its waist.
void add_shadow_planes_of_pot(Scene& scene, const PotLooks& looks, const glm::dmat4& pot) {
  const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
  Mesh body, top, spout, disc_mesh;
  add_pot(body, looks);
  add_top(top, looks);
  add_spout(spout, looks);
  add_part(disc_mesh, cylinder(1.0, 1.0, 0.1, 48), looks.rim);
  const std::vector<glm::dvec3> along = spout_path(), handle = handle_path();
  const glm::dvec3 root = along.front(), tip = along.back(), end = tip - along[along.size() - 2];
  // A little inside the glaze, which coarse texels would darken.
  const glm::dvec2 within_waist(2.2 * 0.985 * waist_radius);
  const glm::dvec2 across_knob(2.2 * knob_radius), across_tip(2.2 * spout_tip_radius);
  const glm::dvec3 middle = 0.5 * (root + tip);
  const double reach = glm::length(tip - root) + 0.5;
  std::vector<ShadowPlane> planes = {
      pot_plane("top, from the front", {0.0, 1.665, 0.0}, x, y, {1.4, 0.54}, "top"),
      pot_plane("top, from the side", {0.0, 1.665, 0.0}, z, y, {1.4, 0.54}, "top"),
      pot_plane("knob", {0.0, knob_height, 0.0}, x, -z, across_knob, "disc"),
      pot_plane("spout, from the side", {1.35, 1.0, 0.0}, x, y, {1.3, 1.5}, "spout from the side"),
      pot_plane("spout, from above", middle, tip - root, z, {reach, 0.6}, "spout from above"),
      pot_plane("spout's tip", tip, z, glm::cross(z, end), across_tip, "disc"),
      pot_plane("body, from the front", {0.0, 0.74, 0.0}, x, y, {2.4, 1.6}, "body"),
      pot_plane("body, from the side", {0.0, 0.74, 0.0}, z, y, {2.4, 1.6}, "body"),
      pot_plane("body's waist", {0.0, waist_height, 0.0}, x, -z, within_waist, "waist")};
  const ShadowPlane unit = pot_plane("", {}, x, -z, glm::dvec2(2.2), "disc");
  scene.textures.push_back(silhouette_texture("top", top, planes[0], 256));
  scene.textures.push_back(silhouette_texture("disc", disc_mesh, unit, 64));
  scene.textures.push_back(silhouette_texture("body", body, planes[6], 512));
  scene.textures.push_back(silhouette_texture("waist", disc_mesh, unit, 512));
  scene.textures.push_back(silhouette_texture("spout from the side", spout, planes[3], 256));
  scene.textures.push_back(silhouette_texture("spout from above", spout, planes[4], 256));
  scene.textures.push_back({"dark", 1, 1, {0, 0, 0, 255}});
  constexpr std::size_t pieces = 5;
  for (std::size_t i = 0; i < pieces; ++i) {
    const glm::dvec3 from = handle[i * (handle.size() - 1) / pieces];
    const glm::dvec3 to = handle[(i + 1) * (handle.size() - 1) / pieces];
    planes.push_back(pot_plane("handle " + std::to_string(i + 1), 0.5 * (from + to), to - from, z,
                               {glm::length(to - from), 2.0 * handle_radius}, "dark"));
  }
  for (const ShadowPlane& plane : planes) scene.shadow_planes.push_back(moved_plane(plane, pot));
}

}  // namespace

/// A teapot of round parts on a table: body, lid, knob, spout and handle, each closed. Lengths are
/// in decimetres of a big pot, so that 1 m is about its radius.
Scene make_teapot() {
  SceneBuilder b("teapot", "A teapot on a table");
  const Look table = b.look("table", {0.95f, 0.90f, 0.84f}, b.texture("wood", 91), 2.2);
  const PotLooks looks = {b.look("glaze", {0.16f, 0.34f, 0.46f}, -1, 1.0, 0.16f, 140.0f),
                          b.look("rim", {0.72f, 0.62f, 0.42f}, -1, 1.0, 0.14f, 90.0f)};
  b.ground({-8.0, -8.0}, {8.0, 8.0}, table, "table");
  Mesh pot;
  add_pot(pot, looks);
  add_top(pot, looks);
  add_spout(pot, looks);
  add_handle(pot, looks);
  b.place(b.add_mesh("teapot", std::move(pot)), turn_y(-24.0), "teapot");
  add_shadow_planes_of_pot(b.scene, looks, turn_y(-24.0));
  b.spot("lamp", {3.4, 5.2, 3.0}, {0.0, 0.6, 0.0}, {1.0f, 0.95f, 0.86f}, 1.2f, 32.0, disc(0.12))
      .inner_angle = 20.0;
  b.camera("main", {0.9, 3.1, 5.6}, {0.12, 0.62, 0.0}, 44.0);
  b.scene.ambient = glm::vec3(0.13f);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
