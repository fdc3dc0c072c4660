#include "scenes/built_in/island_parts.h"

#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

/// A frond: a spine that rises and droops, with leaflets on both sides that hang from it.
void add_frond(Mesh& mesh, const Look& leaf, const glm::dmat4& crown, double length, double rise) {
  const int steps = 7;
  std::vector<glm::dvec3> spine;
  std::vector<double> radii;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    spine.emplace_back(length * (t - 0.12 * t * t), length * (rise * t - 0.75 * t * t * t), 0.0);
    radii.push_back(0.028 * (1.0 - 0.8 * t) + 0.004);
  }
  add_part(mesh, tube(spine, radii, 4), leaf, crown, 60.0);
  for (int i = 1; i <= 2 * steps; ++i) {
    const double t = (i - 0.5) / (2 * steps);
    const auto low = static_cast<std::size_t>(t * steps);
    const double part = t * steps - static_cast<double>(low);
    const glm::dvec3 root = glm::mix(spine[low], spine[low + 1], part);
    const double reach = length * 0.30 * (0.35 + 1.5 * t * (1.15 - t));
    for (const double side : {-1.0, 1.0}) {
      const glm::dvec3 tip = root + glm::dvec3(0.45 * reach, -0.42 * reach, side * 0.88 * reach);
      const glm::dvec3 middle = 0.5 * (root + tip) + glm::dvec3(0.0, 0.09 * reach, 0.0);
      add_part(mesh, tube({root, middle, tip}, {0.02, 0.05, 0.006}, 3), leaf, crown, 20.0);
    }
  }
}

}  // namespace

Mesh make_palm(const Look& bark, const Look& leaf, const Look& nut, std::uint32_t seed) {
  Random random(seed);
  Mesh mesh;
  const double height = random.range(5.2, 6.8), lean = random.range(0.8, 1.9);
  std::vector<glm::dvec3> trunk;
  std::vector<double> radii;
  const int steps = 10;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    trunk.emplace_back(lean * t * t, height * t - 0.4, 0.12 * lean * t * (1.0 - t));
    radii.push_back(0.22 - 0.11 * t + 0.10 * (1.0 - t) * (1.0 - t) * (1.0 - t) * (1.0 - t));
  }
  add_part(mesh, tube(trunk, radii, 10), bark, glm::dmat4(1.0), 60.0);
  const glm::dvec3 top = trunk.back();
  const int fronds = 9;
  for (int i = 0; i < fronds; ++i) {
    const double angle = 360.0 * i / fronds + random.range(-9.0, 9.0);
    add_frond(mesh, leaf, move(top) * turn_y(angle), random.range(2.2, 2.9),
              random.range(0.15, 0.65));
  }
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 c = circle(90.0 * i + 20.0);
    add_part(mesh, sphere(0.13, 12, 8), nut, move(top + glm::dvec3(0.17 * c.x, -0.2, 0.17 * c.y)),
             60.0);
  }
  return mesh;
}

Mesh make_hut(const Look& planks, const Look& thatch) {
  Mesh mesh;
  const double w = 1.9, d = 1.5, floor = 0.55, eaves = 2.75;
  for (const double x : {-w, 0.0, w})
    for (const double z : {-d, d})
      add_part(mesh, cylinder(0.085, 0.07, eaves + 0.6, 10), planks, move({x, -0.6, z}));
  add_part(mesh, box({-w - 0.25, floor - 0.09, -d - 0.25}, {w + 0.25, floor, d + 0.9}), planks);
  const auto wall = [&](const std::vector<double>& xs, const std::vector<double>& ys,
                        const std::vector<std::array<int, 2>>& holes, const glm::dmat4& where) {
    add_part(mesh, plate(xs, ys, holes, 0.06), planks, where);
  };
  const double top = eaves - 0.15;
  wall({-w, -1.25, -0.35, 0.35, 1.2, w}, {floor, 1.25, 2.05, top}, {{1, 1}, {3, 0}, {3, 1}},
       move({0.0, 0.0, d}));
  wall({-w, w}, {floor, top}, {}, move({0.0, 0.0, -d}));
  wall({-d + 0.03, -0.4, 0.4, d - 0.03}, {floor, 1.25, 2.05, top}, {{1, 1}},
       move({w - 0.032, 0.0, 0.0}) * turn_y(90.0));
  wall({-d + 0.03, -0.4, 0.4, d - 0.03}, {floor, 1.25, 2.05, top}, {{1, 1}},
       move({-w + 0.032, 0.0, 0.0}) * turn_y(-90.0));
  // Thatch in three skirts, each a frustum of four sides.
  for (int i = 0; i < 3; ++i) {
    const double low = 1.0 - 0.30 * i, high = i == 2 ? 0.10 : low - 0.36;
    const double y = eaves - 0.35 + 0.52 * i;
    const auto rim = [&](double s, double h) {
      return std::vector<glm::dvec3>{{-s * (w + 0.75), h, -s * (d + 0.85)},
                                     {-s * (w + 0.75), h, s * (d + 0.85)},
                                     {s * (w + 0.75), h, s * (d + 0.85)},
                                     {s * (w + 0.75), h, -s * (d + 0.85)}};
    };
    add_part(mesh, loft({rim(low, y), rim(low, y + 0.10), rim(high, y + 0.76)}), thatch);
  }
  for (int i = 0; i < 3; ++i)
    add_part(mesh,
             box({-0.45, 0.14 * i - 0.05, d + 0.95 + 0.22 * (2 - i)},
                 {0.45, 0.14 * i + 0.02, d + 1.20 + 0.22 * (2 - i)}),
             planks, move({0.78, 0.02, 0.0}));
  return mesh;
}

Mesh make_jetty(const Look& planks) {
  Mesh mesh;
  const int boards = 26;
  for (int i = 0; i < boards; ++i) {
    const double x = 0.30 * i;
    add_part(mesh,
             box({x, 0.56 + 0.012 * (i % 3), -0.75}, {x + 0.26, 0.62 + 0.012 * (i % 3), 0.75}),
             planks, turn_y((i * 7 % 5 - 2) * 0.12));
  }
  for (const double z : {-0.6, 0.6}) {
    add_part(mesh, box({0.02, 0.44, z - 0.05}, {7.76, 0.55, z + 0.05}), planks);
    for (int i = 0; i < 5; ++i)
      add_part(mesh, cylinder(0.09, 0.08, 2.1 + 0.2 * (i % 2), 10), planks,
               move({0.45 + 1.72 * i, -1.1, z * 1.42}));
  }
  return mesh;
}

Mesh make_boat(const Look& hull, const Look& inside) {
  // Sections from stern to bow: U-shaped rings of constant wall.
  std::vector<std::vector<glm::dvec3>> rings;
  const int sections = 11;
  for (int i = 0; i < sections; ++i) {
    const double t = static_cast<double>(i) / (sections - 1);
    const double half =
        0.62 * (1.0 - 0.93 * t * t * t) * (0.86 + 0.14 * (1.0 - (1.0 - t) * (1.0 - t)));
    const double sheer = 0.42 + 0.30 * t * t, keel = -0.16 + 0.34 * t * t * t;
    const double wall = 0.045, x = 3.2 * t - 1.6;
    const glm::dvec2 outer[4] = {{half, sheer},
                                 {0.88 * half, 0.35 * sheer + 0.65 * keel},
                                 {0.45 * half, 0.93 * keel + 0.07 * sheer},
                                 {0.0, keel}};
    std::vector<glm::dvec3> ring;
    for (int k = 0; k < 4; ++k) ring.emplace_back(x, outer[k].y, outer[k].x);
    for (int k = 2; k >= 0; --k) ring.emplace_back(x, outer[k].y, -outer[k].x);
    const double scale = half > 2.0 * wall ? (half - wall) / half : 0.3;
    for (int k = 0; k < 4; ++k)
      ring.emplace_back(x, outer[k].y + (k == 0 ? 0.0 : wall), -scale * outer[k].x);
    for (int k = 2; k >= 0; --k)
      ring.emplace_back(x, outer[k].y + (k == 0 ? 0.0 : wall), scale * outer[k].x);
    rings.push_back(ring);
  }
  Mesh mesh;
  add_part(mesh, loft(rings), hull, glm::dmat4(1.0), 30.0);
  for (const double x : {-1.1, -0.2, 0.6})
    add_part(
        mesh,
        box({x - 0.14, 0.24, -0.57 + 0.02 * (x + 1.1)}, {x + 0.14, 0.28, 0.57 - 0.02 * (x + 1.1)}),
        inside);
  return mesh;
}

}  // namespace penumbra::scenes
