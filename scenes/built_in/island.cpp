#include <algorithm>
#include <cmath>

#include "scenes/built_in/built_in.h"
#include "scenes/built_in/island_parts.h"
#include "scenes/generators/noise.h"
#include "scenes/generators/random.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {
namespace {

/// Distance from the island's middle in radii of its shore, which noise makes irregular.
double shore(double x, double z) {
  static const FractalNoise noise(6, 6, 3, 71);
  const double bend = noise(0.5 + x / 60.0, 0.5 + z / 60.0) - 0.5;
  return std::sqrt(x * x / (13.5 * 13.5) + z * z / (10.0 * 10.0)) + 0.75 * bend;
}

/// Height of the sand above the sea, metres.
double sand_height(double x, double z) {
  static const FractalNoise noise(12, 12, 3, 72);
  const double inside = 1.0 - shore(x, z);
  const double dunes = 0.25 * (noise(0.5 + x / 40.0, 0.5 + z / 40.0) - 0.5);
  return (inside > 0.0 ? 2.1 * inside * (2.0 - inside) : 3.0 * inside) + dunes;
}

/// Height of the grass: above the sand on a hill in the west, below it elsewhere.
double grass_height(double x, double z) {
  const double dx = (x + 3.2) / 7.0, dz = (z + 1.2) / 5.2;
  const double hill = 1.0 - dx * dx - dz * dz;
  static const FractalNoise noise(10, 10, 4, 73);
  const double bumps = noise(0.5 + x / 40.0, 0.5 + z / 40.0) - 0.5;
  return sand_height(x, z) + std::max(-0.6, 0.95 * hill + 0.9 * bumps - 0.08);
}

Mesh terrain(const glm::dvec2& low, const glm::dvec2& high, int columns, int rows, double bottom,
             double (*height)(double, double), const Look& look) {
  std::vector<double> heights;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      heights.push_back(std::max(bottom + 0.05, height(low.x + (high.x - low.x) * i / (columns - 1),
                                                       low.y + (high.y - low.y) * j / (rows - 1))));
  Mesh mesh;
  add_part(mesh, height_field(low, high, columns, heights, bottom), look, glm::dmat4(1.0), 60.0);
  return mesh;
}

double on_island(double x, double z) {
  return std::max(sand_height(x, z), grass_height(x, z));
}

double sea_level(double, double) {
  return 0.0;
}

/// Flat sea, turquoise over the shallows around the island.
Mesh make_sea(const Look& look) {
  Mesh mesh = terrain({-75.0, -80.0}, {75.0, 45.0}, 40, 34, -3.5, sea_level, look);
  for (const glm::vec3& p : mesh.positions) {
    const double away = shore(static_cast<double>(p.x), static_cast<double>(p.z)) - 1.0;
    const double shallow = 1.0 - smooth_step(-0.05, 0.55, away);
    mesh.colors.emplace_back(
        glm::mix(glm::vec3(1.0f), glm::vec3(2.1f, 1.75f, 1.35f), static_cast<float>(shallow)),
        1.0f);
  }
  return mesh;
}

void add_plants_and_rocks(SceneBuilder& b) {
  const Look bark = b.look("bark", {1.0f, 0.95f, 0.9f}, b.texture("bark", 31), 0.9);
  const Look leaf = b.look("leaf", {0.95f, 1.0f, 0.85f}, b.texture("leaf", 32), 0.8, 0.08f, 24.0f);
  const Look nut = b.look("coconut", {0.30f, 0.20f, 0.10f});
  const Look stone = b.look("rock", {0.95f, 0.93f, 0.90f}, b.texture("rock", 33), 1.6);
  const std::uint32_t palms[3] = {b.add_mesh("palm 1", make_palm(bark, leaf, nut, 1)),
                                  b.add_mesh("palm 2", make_palm(bark, leaf, nut, 2)),
                                  b.add_mesh("palm 3", make_palm(bark, leaf, nut, 3))};
  const double at[8][3] = {{-7.2, 0.6, 200.0},  {-5.6, -2.6, 150.0}, {-3.4, 1.6, 250.0},
                           {-1.2, -4.0, 60.0},  {6.6, -2.9, 20.0},   {7.8, -1.2, 330.0},
                           {-9.2, -1.6, 170.0}, {1.9, -5.2, 95.0}};
  for (int i = 0; i < 8; ++i)
    b.place(palms[i % 3],
            move({at[i][0], on_island(at[i][0], at[i][1]), at[i][1]}) * turn_y(at[i][2]));
  std::uint32_t rocks[3];
  for (std::uint32_t i = 0; i < 3; ++i) {
    Mesh mesh;
    add_part(mesh, boulder(41 + i, 0.75, 16, 10), stone, glm::dmat4(1.0), 40.0);
    rocks[i] = b.add_mesh("rock " + std::to_string(i + 1), std::move(mesh));
  }
  Random random(5);
  const double where[12][3] = {{-11.4, 2.4, 1.3}, {-12.6, 1.0, 0.9}, {-10.6, 4.0, 0.7},
                               {10.9, -3.4, 1.1}, {12.2, -2.3, 0.7}, {9.8, -4.6, 0.6},
                               {3.2, 7.9, 0.55},  {4.1, 8.6, 0.8},   {-2.2, 7.4, 0.4},
                               {-6.4, -4.2, 0.9}, {-4.9, -5.1, 0.6}, {5.4, 2.2, 0.35}};
  for (int i = 0; i < 12; ++i) {
    const double size = where[i][2], x = where[i][0], z = where[i][1];
    b.place(rocks[i % 3],
            move({x, std::max(-0.1, on_island(x, z)) + 0.2 * size, z}) *
                turn_y(random.range(0.0, 360.0)) *
                stretch({size * random.range(0.9, 1.4), size * random.range(0.7, 1.0), size}));
  }
}

}  // namespace

/// An island in the sea; the light is so far away that no penumbra can be seen.
Scene make_island() {
  SceneBuilder b("island", "An island in the sea");
  const Look sea = b.look("sea", {0.80f, 0.90f, 0.95f}, b.texture("water", 30), 11.0, 0.10f, 90.0f);
  const Look sand = b.look("sand", {0.95f, 0.93f, 0.90f}, b.texture("sand", 34), 5.0);
  const Look grass = b.look("grass", {0.95f, 0.97f, 0.90f}, b.texture("grass", 35), 5.0);
  const Look planks = b.look("planks", {0.82f, 0.80f, 0.76f}, b.texture("wood", 36), 1.1);
  const Look thatch = b.look("thatch", {0.98f, 0.82f, 0.52f}, b.texture("bark", 37), 0.8);
  const Look hull =
      b.look("hull", {0.70f, 0.16f, 0.10f}, b.texture("painted_metal", 38), 1.5, 0.08f, 40.0f);

  b.place(b.add_mesh("sea", make_sea(sea)), glm::dmat4(1.0));
  b.scene.receivers.push_back(
      {"sea", {{-75.0, 0.0, -80.0}, {-75.0, 0.0, 45.0}, {75.0, 0.0, 45.0}, {75.0, 0.0, -80.0}}});
  b.place(
      b.add_mesh("sand", terrain({-17.0, -14.0}, {17.0, 14.0}, 57, 47, -3.0, sand_height, sand)),
      glm::dmat4(1.0));
  b.place(
      b.add_mesh("grass", terrain({-12.0, -8.5}, {6.0, 6.0}, 41, 33, -2.5, grass_height, grass)),
      glm::dmat4(1.0));
  add_plants_and_rocks(b);
  b.place(b.add_mesh("hut", make_hut(planks, thatch)),
          move({2.6, on_island(2.6, -1.0) - 0.1, -1.0}) * turn_y(-18.0));
  b.place(b.add_mesh("jetty", make_jetty(planks)), move({6.2, 0.25, 5.3}) * turn_y(-38.0));
  b.place(b.add_mesh("boat", make_boat(hull, planks)), move({11.4, 0.12, 6.4}) * turn_y(-52.0));

  b.spot("sun", {-120.0, 190.0, 85.0}, {0.0, 0.0, -8.0}, {1.0f, 0.95f, 0.84f}, 1.2f, 17.5,
         disc(0.25));
  b.camera("main", {10.5, 19.5, 28.5}, {1.3, 0.6, 0.0}, 41.0);
  b.scene.ambient = {0.17f, 0.20f, 0.25f};
  b.scene.background_low = {0.62f, 0.74f, 0.86f};
  b.scene.background_high = {0.20f, 0.38f, 0.68f};
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
