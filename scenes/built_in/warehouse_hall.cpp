#include <cmath>
#include <string>

#include "scenes/built_in/warehouse_parts.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

constexpr double half_length = 15.0, half_width = 9.0, eaves = 6.0, ridge = 8.4, bay = 6.0;

/// Brick up to the sills, plaster above, as two plates each with door and window openings.
void add_walls(SceneBuilder& b, const Look& brick, const Look& sheet) {
  const double split = 3.4;
  // Front, towards +z: a door 4 m wide and high, and a window in every other bay.
  const std::vector<double> front_x = {-half_length, -13.5, -10.5, -7.5, -4.5, -2.0,
                                       2.0,          4.5,   7.5,   10.5, 13.5, half_length};
  b.place(plate(front_x, {0.0, 1.5, 3.0, split},
                {{1, 1}, {3, 1}, {5, 0}, {5, 1}, {5, 2}, {7, 1}, {9, 1}}, 0.3),
          brick, "front wall", move({0.0, 0.0, half_width}));
  b.place(plate(front_x, {split, 4.0, eaves}, {{5, 0}}, 0.2), sheet, "front sheet",
          move({0.0, 0.0, half_width}));
  const std::vector<double> back_x = {-half_length, -10.5, -7.5, -1.5, 1.5, 7.5, 10.5, half_length};
  b.place(plate(back_x, {0.0, 1.5, 3.0, split}, {{1, 1}, {3, 1}, {5, 1}}, 0.3), brick, "back wall",
          move({0.0, 0.0, -half_width}));
  b.place(plate({-half_length, half_length}, {split, eaves}, {}, 0.2), sheet, "back sheet",
          move({0.0, 0.0, -half_width}));
  // Ends: the lower part as a plate, the gable as a swept polygon.
  const double inner = half_width - 0.15;
  const std::vector<glm::dvec2> gable = {{-inner, split},
                                         {inner, split},
                                         {inner, eaves - 0.05},
                                         {0.0, ridge - 0.1},
                                         {-inner, eaves - 0.05}};
  for (const double side : {-1.0, 1.0}) {
    const glm::dmat4 where = move({side * (half_length - 0.15), 0.0, 0.0}) * turn_y(90.0 * side);
    const std::string name = side < 0.0 ? "west" : "east";
    b.place(
        plate({-inner, -5.5, -2.5, 2.5, 5.5, inner}, {0.0, 1.5, 3.0, split}, {{1, 1}, {3, 1}}, 0.3),
        brick, name + " wall", where);
    b.place(extrude(gable, 0.2), sheet, name + " gable", where);
  }
}

/// Two slopes with a skylight in every bay, and the ridge's cap.
void add_roof(SceneBuilder& b, const Look& sheet, const Look& metal) {
  const double rise = ridge - eaves, run = half_width + 0.5;
  const double slope = std::sqrt(rise * rise + half_width * half_width);
  const double length = slope * run / half_width;
  std::vector<double> xs = {-half_length - 0.4};
  std::vector<std::array<int, 2>> holes;
  for (int i = 0; i < 5; ++i) {
    const double middle = -half_length + bay * (i + 0.5);
    xs.push_back(middle - 1.2);
    xs.push_back(middle + 1.2);
    holes.push_back({2 * i + 1, 1});
  }
  xs.push_back(half_length + 0.4);
  const double angle = 57.29577951308232 * std::atan(rise / half_width);
  for (const double side : {-1.0, 1.0}) {
    // The plate's y runs from the eaves up to the ridge, its front looks to the sky.
    const glm::dmat4 where = move({0.0, ridge, 0.0}) * turn_y(side > 0.0 ? 0.0 : 180.0) *
                             turn_x(-90.0 + angle) * move({0.0, -length, 0.0});
    Mesh mesh;
    add_part(mesh, plate(xs, {0.0, 0.38 * length, 0.70 * length, length - 0.02}, holes, 0.12),
             sheet);
    b.place(b.add_mesh(side > 0.0 ? "front slope" : "back slope", std::move(mesh)), where);
  }
  b.place(cylinder(0.16, 0.16, 2.0 * half_length + 0.9, 10), metal, "ridge cap",
          move({half_length + 0.45, ridge + 0.02, 0.0}) * turn_z(90.0));
}

/// A truss of steel bars between two columns, in the plane x = 0.
Mesh make_truss(const Look& steel) {
  Mesh mesh;
  const double w = half_width - 0.45, low = eaves - 0.55, rise = ridge - eaves;
  const auto roof = [&](double z) { return ridge - 0.32 - rise * std::abs(z) / half_width; };
  for (const double z : {-w, w})
    add_part(mesh, box({-0.14, 0.0, z - 0.14}, {0.14, roof(w) + 0.05, z + 0.14}), steel);
  add_part(mesh, bar({0.0, low, -w}, {0.0, low, w}, 0.16, 0.20), steel);
  for (const double side : {-1.0, 1.0}) {
    add_part(mesh, bar({0.0, roof(w), side * w}, {0.0, roof(0.0), side * 0.01}, 0.15, 0.18), steel);
    const double z1 = side * w / 3.0, z2 = side * 2.0 * w / 3.0;
    for (const double z : {z1, z2})
      add_part(mesh, bar({0.0, low, z}, {0.0, roof(z), z}, 0.09, 0.09, {0.0, 0.0, 1.0}), steel);
    add_part(mesh, bar({0.0, low, z1}, {0.0, roof(0.0), side * 0.05}, 0.085, 0.09), steel);
    add_part(mesh, bar({0.0, low, z2}, {0.0, roof(z1), z1}, 0.085, 0.09), steel);
  }
  return mesh;
}

}  // namespace

void add_hall(SceneBuilder& b) {
  const Look brick = b.look("brick", {0.95f, 0.92f, 0.90f}, b.texture("brick", 51), 1.1);
  const Look sheet = b.look("wall sheet", {0.80f, 0.84f, 0.80f}, b.texture("corrugated", 52), 2.4);
  const Look roof = b.look("roof sheet", {0.86f, 0.72f, 0.66f}, b.texture("corrugated", 53), 2.4);
  const Look steel =
      b.look("steel", {0.26f, 0.36f, 0.40f}, b.texture("painted_metal", 54), 2.0, 0.10f, 40.0f);
  add_walls(b, brick, sheet);
  add_roof(b, roof, steel);
  const std::uint32_t truss = b.add_mesh("truss", make_truss(steel));
  for (int i = 0; i < 6; ++i)
    b.place(truss, move({-half_length + 0.45 + (2.0 * half_length - 0.9) * i / 5.0, 0.0, 0.0}),
            "truss " + std::to_string(i + 1));
  // Purlins under the roof from gable to gable.
  Mesh purlins;
  for (const double side : {-1.0, 1.0})
    for (const double z : {2.0, 4.1, 6.4, 8.2}) {
      const double y = ridge - 0.17 - (ridge - eaves) * z / half_width;
      add_part(purlins,
               bar({-half_length + 0.3, y, side * z}, {half_length - 0.3, y, side * z}, 0.09, 0.13),
               steel);
    }
  b.place(b.add_mesh("purlins", std::move(purlins)), glm::dmat4(1.0));
}

void add_goods(SceneBuilder& b) {
  const int wood = b.texture("wood", 55), carton = b.texture("cardboard", 56),
            paint = b.texture("painted_metal", 54);
  const Look post = b.look("rack blue", {0.10f, 0.24f, 0.52f}, paint, 1.5, 0.08f, 40.0f);
  const Look board = b.look("rack boards", {0.92f, 0.88f, 0.80f}, wood, 1.4);
  const Look crate_wood = b.look("crate wood", {1.0f, 0.94f, 0.84f}, wood, 1.1);
  const Look box_look = b.look("carton", {1.0f, 0.97f, 0.93f}, carton, 0.8);
  const Look pale = b.look("pale carton", {1.0f, 1.06f, 1.1f}, carton, 0.8);
  const Look barrels[2] = {
      b.look("barrel blue", {0.13f, 0.30f, 0.50f}, paint, 1.0, 0.12f, 50.0f),
      b.look("barrel orange", {0.78f, 0.36f, 0.10f}, paint, 1.0, 0.12f, 50.0f)};
  const std::uint32_t rack = b.add_mesh("rack", make_rack(post, board));
  const std::uint32_t crate = b.add_mesh("crate", make_slatted_crate(crate_wood, 1.0));
  const std::uint32_t pallet = b.add_mesh("pallet", make_pallet(crate_wood));
  const std::uint32_t barrel[2] = {b.add_mesh("blue barrel", make_barrel(barrels[0])),
                                   b.add_mesh("orange barrel", make_barrel(barrels[1]))};
  std::uint32_t cartons[4];
  const glm::dvec3 sizes[4] = {
      {0.8, 0.6, 0.7}, {0.6, 0.45, 0.6}, {1.0, 0.9, 0.8}, {0.7, 1.0, 0.75}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    Mesh mesh;
    const glm::dvec3 h(0.5 * sizes[i].x, sizes[i].y, 0.5 * sizes[i].z);
    add_part(mesh, box({-h.x, 0.0, -h.z}, h), i % 2 ? pale : box_look);
    cartons[i] = b.add_mesh("carton " + std::to_string(i + 1), std::move(mesh));
  }
  Random random(8);
  const double racks[6][3] = {{-9.0, -7.6, 0.0}, {-3.0, -7.6, 0.0}, {3.0, -7.6, 0.0},
                              {9.0, -7.6, 0.0},  {-9.0, -3.6, 0.0}, {-13.2, 3.6, 90.0}};
  for (const auto& r : racks) {
    const glm::dmat4 where = move({r[0], 0.0, r[1]}) * turn_y(r[2]);
    b.place(rack, where);
    for (int level = 0; level < 3; ++level)
      for (int k = 0; k < 5; ++k) {
        if (random.uniform() < 0.22) continue;
        const double x = -2.15 + 1.07 * k + random.range(-0.06, 0.06);
        b.place(cartons[random.below(4)],
                where * move({x, 0.181 + 1.6 * level, random.range(-0.1, 0.1)}) *
                    turn_y(random.range(-5.0, 5.0)));
      }
  }
  // Crates on pallets and barrels on the floor.
  const double stacks[9][4] = {{-4.2, 0.6, 12.0, 2},  {-2.7, 1.3, -8.0, 1}, {3.4, -3.2, 20.0, 2},
                               {5.0, -2.6, -15.0, 1}, {8.6, 2.6, 30.0, 2},  {-7.6, 4.8, 5.0, 2},
                               {10.6, -1.8, 75.0, 1}, {4.6, 3.9, 28.0, 1},  {3.0, 5.6, -20.0, 0}};
  for (const auto& s : stacks) {
    const glm::dmat4 where = move({s[0], 0.0, s[1]}) * turn_y(s[2]);
    b.place(pallet, where);
    for (int k = 0; k < static_cast<int>(s[3]); ++k)
      b.place(crate, where * move({0.0, 0.145 + 1.001 * k, 0.0}) * turn_y(7.0 * k) *
                         stretch({1.0, 1.0, 0.8}));
  }
  const double drums[9][3] = {{1.0, 2.6, 0},   {1.65, 2.75, 1}, {1.25, 3.25, 0},
                              {-5.9, -0.8, 1}, {-6.6, -0.6, 0}, {12.4, 5.4, 1},
                              {12.9, 4.8, 0},  {12.2, 4.6, 0},  {6.3, 2.7, 1}};
  for (const auto& d : drums)
    b.place(barrel[static_cast<int>(d[2])],
            move({d[0], 0.0, d[1]}) * turn_y(random.range(0.0, 360.0)));
}

}  // namespace penumbra::scenes
