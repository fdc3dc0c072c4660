#include <cmath>

#include "scenes/built_in/built_in.h"
#include "scenes/built_in/outdoors.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

constexpr double tower_height = 46.0;
constexpr double joined_at = 22.0;  ///< height where the four legs become one column, metres

/// Half of the tower's outer width at a height, metres: wide feet that curve inwards.
double half_width_at(double y) {
  const double t = 1.0 - y / tower_height;
  return 0.55 + 8.6 * t * t * t;
}

/// Half the width of a leg, metres.
double half_leg(double y) {
  return 0.42 + 0.55 * (1.0 - y / joined_at);
}

/// Four posts through `rings` of four corners each, and on every side between two rings crossed
/// braces under a bar.
void add_lattice(Mesh& mesh, const std::vector<std::array<glm::dvec3, 4>>& rings, double post,
                 double brace, const Look& iron) {
  for (std::size_t corner = 0; corner < 4; ++corner) {
    std::vector<glm::dvec3> path;
    for (const auto& ring_of : rings) path.push_back(ring_of[corner]);
    add_part(mesh, tube(path, std::vector<double>(path.size(), post), 4), iron);
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::size_t next = (corner + 1) % 4;
      const glm::dvec3 out = rings[i][corner] + rings[i][next] - rings[i][(corner + 2) % 4] -
                             rings[i][(corner + 3) % 4];
      const auto brace_between = [&](const glm::dvec3& from, const glm::dvec3& to, double size) {
        add_part(mesh, bar(from, to, size, 0.7 * size, out), iron);
      };
      brace_between(rings[i][corner], rings[i + 1][next], brace);
      brace_between(rings[i][next], rings[i + 1][corner], 0.98 * brace);
      brace_between(rings[i + 1][corner], rings[i + 1][next], 1.1 * brace);
    }
}

/// Corners of a level square around (x, z), counter-clockwise seen from above.
std::array<glm::dvec3, 4> square(double x, double y, double z, double half) {
  return {glm::dvec3(x - half, y, z - half), glm::dvec3(x - half, y, z + half),
          glm::dvec3(x + half, y, z + half), glm::dvec3(x + half, y, z - half)};
}

/// A floor around the tower with a railing.
void add_gallery(Mesh& mesh, double y, double half, const Look& floor, const Look& iron) {
  add_part(mesh, box({-half, y - 0.12, -half}, {half, y + 0.12, half}), floor);
  for (int side = 0; side < 4; ++side) {
    const glm::dmat4 turned = turn_y(90.0 * side);
    add_part(
        mesh,
        bar({-half + 0.11, y + 1.1, half - 0.1}, {half - 0.12, y + 1.1, half - 0.1}, 0.1, 0.08),
        iron, turned);
    const int posts = static_cast<int>(half / 0.6);
    for (int i = 0; i < posts; ++i) {
      const double x = (2.0 * (i + 0.5) / posts - 1.0) * (half - 0.15);
      add_part(mesh, box({x - 0.03, y + 0.1, half - 0.13}, {x + 0.03, y + 1.07, half - 0.07}), iron,
               turned);
    }
  }
}

/// The arches between the feet.
void add_arches(Mesh& mesh, const Look& iron) {
  const double reach = half_width_at(0.0) - 2.0 * half_leg(0.0) + 0.4, top = 8.2;
  const double z = half_width_at(4.0) - 1.0;
  for (int side = 0; side < 4; ++side) {
    std::vector<glm::dvec3> arch;
    for (int i = 0; i <= 16; ++i) {
      const glm::dvec2 c = circle(180.0 - 180.0 * i / 16);
      arch.emplace_back(reach * c.x, 0.9 + (top - 0.9) * c.y, z - 0.10 * (top - 0.9) * c.y);
    }
    add_part(mesh, tube(arch, std::vector<double>(arch.size(), 0.17), 4), iron,
             turn_y(90.0 * side));
  }
}

}  // namespace

/// A tower of iron lattice, about 10,800 triangles with its ground: thin casters in front of thin
/// casters, the hardest shadows for filters (Adorjan 2013, 4).
Scene make_tower() {
  SceneBuilder b("tower", "A lattice tower");
  const Look gravel = b.look("gravel", {0.93f, 0.90f, 0.84f}, b.texture("sand", 121), 6.0);
  const Look iron =
      b.look("iron", {0.52f, 0.42f, 0.34f}, b.texture("painted_metal", 122), 1.5, 0.08f, 40.0f);
  const Look plinth = b.look("plinth", {0.90f, 0.88f, 0.84f}, b.texture("concrete", 123), 3.0);
  b.ground({-60.0, -60.0}, {60.0, 40.0}, gravel, "square", 0.5);
  Mesh mesh;
  for (const double sx : {-1.0, 1.0})
    for (const double sz : {-1.0, 1.0}) {
      std::vector<std::array<glm::dvec3, 4>> rings;
      for (int i = 0; i <= 10; ++i) {
        const double y = 0.6 + (joined_at - 0.6) * i / 10.0;
        const double middle = half_width_at(y) - half_leg(y);
        rings.push_back(square(sx * middle, y, sz * middle, half_leg(y)));
      }
      add_lattice(mesh, rings, 0.13, 0.12, iron);
      const double foot = half_width_at(0.6) - half_leg(0.6);
      add_part(
          mesh,
          box({sx * foot - 1.5, -0.1, sz * foot - 1.5}, {sx * foot + 1.5, 0.75, sz * foot + 1.5}),
          plinth);
    }
  std::vector<std::array<glm::dvec3, 4>> column;
  for (int i = 0; i <= 13; ++i) {
    const double y = joined_at + (tower_height - joined_at) * i / 13.0;
    column.push_back(square(0.0, y, 0.0, half_width_at(y)));
  }
  add_lattice(mesh, column, 0.12, 0.10, iron);
  add_arches(mesh, iron);
  add_gallery(mesh, 9.4, half_width_at(9.4) + 0.6, iron, iron);
  add_gallery(mesh, joined_at, half_width_at(joined_at) + 0.7, iron, iron);
  add_gallery(mesh, tower_height, 1.15, iron, iron);
  add_part(mesh, cylinder(0.10, 0.03, 6.0, 8), iron, move({0.0, tower_height, 0.0}), 40.0);
  gather_materials(mesh);
  b.place(b.add_mesh("tower", std::move(mesh)), turn_y(12.0));
  b.sun({-0.72, -0.66, 0.22}, {1.0f, 0.93f, 0.80f}, 1.2f);
  b.camera("main", {-26.0, 25.0, 42.0}, {-7.0, 13.0, 0.0}, 56.0);
  b.camera("below", {-7.5, 1.7, 13.0}, {1.0, 6.0, -3.0}, 62.0);
  add_sky(b.scene);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
