#include <array>
#include <cmath>
#include <string>

#include "scenes/built_in/built_in.h"
#include "scenes/built_in/outdoors.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

constexpr int houses_a_street = 20;  ///< houses along a street
constexpr int streets = 11;          ///< each between two rows of houses
constexpr double lot = 15.0;         ///< metres of street that a house has
constexpr double block = 44.0;       ///< from street to street, metres
constexpr int church_column = 9;  ///< two lots by this one, on the fourth street, are the church's
constexpr int church_street = 3;

double column_x(int column) {
  return lot * (column - 0.5 * (houses_a_street - 1));
}
double street_z(int street) {
  return -block * street;
}

/// Eight kinds of houses; a town repeats them turned and mirrored.
std::vector<std::uint32_t> add_houses(SceneBuilder& b) {
  const int plaster = b.texture("plaster", 141), brick = b.texture("brick", 142);
  const int tiles = b.texture("tiles", 143), wood = b.texture("wood", 144);
  const glm::vec3 walls[8] = {{0.92f, 0.88f, 0.78f}, {0.95f, 0.78f, 0.70f}, {0.86f, 0.72f, 0.52f},
                              {0.80f, 0.83f, 0.84f}, {1.0f, 0.86f, 0.80f},  {0.90f, 0.80f, 0.74f},
                              {0.74f, 0.80f, 0.72f}, {0.93f, 0.90f, 0.86f}};
  const glm::vec3 roofs[3] = {{0.74f, 0.36f, 0.24f}, {0.52f, 0.30f, 0.24f}, {0.40f, 0.40f, 0.43f}};
  Look roof[3];
  for (std::size_t i = 0; i < 3; ++i)
    roof[i] = b.look("roof " + std::to_string(i + 1), roofs[i], tiles, 1.8);
  const Look timber = b.look("timber", {0.62f, 0.56f, 0.50f}, wood, 1.2);
  const Look glass = b.look("glass", {0.10f, 0.14f, 0.18f}, -1, 1.0, 0.35f, 200.0f);
  const HouseForm forms[8] = {{10.0, 8.0, 2, 0.85, true}, {9.0, 8.0, 3, 0.75, true},
                              {11.0, 7.5, 2, 1.1, true},  {9.0, 9.0, 2, 0.6, false},
                              {10.5, 8.5, 3, 0.9, true},  {11.0, 8.0, 2, 0.7, false},
                              {9.5, 7.5, 1, 1.2, true},   {10.0, 9.0, 3, 0.65, true}};
  std::vector<std::uint32_t> meshes;
  for (std::size_t i = 0; i < 8; ++i) {
    const std::string name = "house " + std::to_string(i + 1);
    const Look wall = b.look(name, walls[i], i % 3 == 1 ? brick : plaster, i % 3 == 1 ? 1.1 : 3.0);
    Mesh mesh;
    add_house(mesh, forms[i], {wall, roof[i % 3], timber, glass});
    gather_materials(mesh);
    meshes.push_back(b.add_mesh(name, std::move(mesh)));
  }
  return meshes;
}

void add_church(SceneBuilder& b, const glm::dmat4& at) {
  const Look stone = b.look("church stone", {0.90f, 0.86f, 0.80f}, b.texture("rock", 145), 2.0);
  const Look slate = b.look("slate", {0.34f, 0.38f, 0.42f}, b.texture("tiles", 146), 1.2);
  const Look glass = b.look("church glass", {0.16f, 0.14f, 0.20f}, -1, 1.0, 0.3f, 120.0f);
  Mesh mesh;
  add_house(mesh, {.width = 22.0, .depth = 10.0, .storeys = 3, .pitch = 1.2, .chimney = false},
            {stone, slate, stone, glass});
  const glm::dmat4 tower = move({-13.0, 0.0, 0.0});
  add_part(mesh, box({-3.0, -0.2, -3.0}, {3.0, 22.0, 3.0}), stone, tower);
  add_part(mesh, box({-3.3, 21.99, -3.3}, {3.3, 22.6, 3.3}), stone, tower);
  add_part(mesh, lathe({{0.0, 22.5}, {3.9, 22.5}, {3.0, 24.0}, {0.0, 36.0}}, 8), slate,
           tower * turn_y(22.5), 20.0);
  for (int side = 0; side < 4; ++side)
    for (const double x : {-1.2, 1.2})
      add_part(mesh, box({x - 0.6, 17.0, 2.9}, {x + 0.6, 20.6, 3.05}), glass,
               tower * turn_y(90.0 * side));
  gather_materials(mesh);
  b.place(b.add_mesh("church", std::move(mesh)), at);
}

/// Streets with pavements, a hair above the grass.
void add_streets(SceneBuilder& b) {
  const Look asphalt = b.look("asphalt", {0.95f, 0.94f, 0.92f}, b.texture("asphalt", 147), 7.0);
  const Look pavement = b.look("pavement", {0.86f, 0.85f, 0.82f}, b.texture("concrete", 148), 3.0);
  const double half = 0.5 * lot * houses_a_street + 8.0;
  Mesh mesh;
  for (int street = 0; street < streets; ++street) {
    const double z = street_z(street);
    add_part(mesh, box({-half, -0.1, z - 3.5}, {half, 0.05, z + 3.5}), asphalt);
    for (const double side : {-4.6, 3.4})
      add_part(mesh, box({-half + 0.01, -0.11, z + side}, {half - 0.01, 0.16, z + side + 1.2}),
               pavement);
  }
  gather_materials(mesh);
  b.place(b.add_mesh("streets", std::move(mesh)), glm::dmat4(1.0));
}

}  // namespace

/// A town of about a million triangles, seeded: rows of houses of eight kinds along streets, trees
/// in the gardens and a church.
Scene make_town() {
  SceneBuilder b("town", "A town of a million triangles");
  const Look grass = b.look("grass", {0.93f, 0.95f, 0.88f}, b.texture("grass", 149), 8.0);
  const double half = 0.5 * lot * houses_a_street + 30.0;
  b.ground({-half, street_z(streets - 1) - 60.0}, {half, 60.0}, grass, "grass", 0.5);
  add_streets(b);
  const std::vector<std::uint32_t> houses = add_houses(b);
  const Look bark = b.look("bark", {0.9f, 0.88f, 0.85f}, b.texture("bark", 150), 1.0);
  const Look leaves = b.look("leaves", {0.90f, 0.97f, 0.78f}, b.texture("leaf", 151), 1.6);
  const std::array<std::uint32_t, 3> trees = {b.add_mesh("tree 1", make_tree(bark, leaves, 31)),
                                              b.add_mesh("tree 2", make_tree(bark, leaves, 32)),
                                              b.add_mesh("tree 3", make_tree(bark, leaves, 33))};
  Random random(1000000);
  for (int street = 0; street < streets; ++street)
    for (const int side : {1, -1})
      for (int column = 0; column < houses_a_street; ++column) {
        // Drawn for every lot, so that one lot's use moves nothing on the next.
        const std::uint32_t kind = random.below(8), tree = random.below(3);
        const double back = random.range(0.0, 3.0), bend = random.range(-3.0, 3.0);
        const double aside = random.range(-4.0, 4.0), size = random.range(0.7, 1.2);
        const bool mirrored = random.uniform() < 0.5, planted = random.uniform() < 0.21;
        const double x = column_x(column), z = street_z(street);
        if (planted)
          b.place(trees[tree], move({x + aside, 0.0, z + side * 19.0}) * turn_y(90.0 * bend) *
                                   stretch(glm::dvec3(size)));
        if (street == church_street && side == 1 &&
            (column == church_column || column == church_column + 1))
          continue;
        // Doors look at the street.
        b.place(houses[kind], move({x, 0.0, z + side * (10.5 + back)}) *
                                  turn_y((side == 1 ? 180.0 : 0.0) + bend) *
                                  stretch({mirrored ? -1.0 : 1.0, 1.0, 1.0}));
      }
  add_church(
      b, move({column_x(church_column) + 0.5 * lot + 3.0, 0.0, street_z(church_street) + 13.0}) *
             turn_y(180.0));
  b.sun({-0.78, -0.56, 0.16}, {1.0f, 0.93f, 0.80f}, 1.2f);
  b.camera("main", {26.0, 31.0, 44.0}, {-8.0, 0.0, -62.0}, 46.0);
  b.camera("street", {24.0, 2.2, 0.6}, {-30.0, 3.4, -2.0}, 55.0);
  add_sky(b.scene);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
