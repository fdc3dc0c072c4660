#include "scenes/built_in/built_in.h"
#include "scenes/built_in/outdoors.h"
#include "scenes/built_in/warehouse_parts.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

struct YardLooks {
  Look ground, stone, wood, timber, rope;
};

/// A well: a ring of stones, two posts, a roller and a small roof.
void add_well(Mesh& mesh, const YardLooks& looks, const Look& roof, const glm::dmat4& at) {
  add_part(mesh, ring({{0.62, -0.1}, {0.92, -0.1}, {0.92, 0.85}, {0.62, 0.85}}, 24), looks.stone,
           at, 40.0);
  for (const double x : {-0.77, 0.77})
    add_part(mesh, box({x - 0.07, 0.6, -0.07}, {x + 0.07, 2.2, 0.07}), looks.timber, at);
  add_part(mesh, cylinder(0.09, 0.09, 1.7, 12), looks.timber,
           at * move({0.85, 1.6, 0.0}) * turn_z(90.0), 40.0);
  add_part(mesh, cylinder(0.015, 0.015, 0.9, 6), looks.rope, at * move({0.0, 0.62, 0.09}), 60.0);
  add_part(
      mesh,
      extrude({{-0.85, 2.02}, {0.0, 2.62}, {0.85, 2.02}, {0.85, 2.1}, {0.0, 2.74}, {-0.85, 2.1}},
              2.0),
      roof, at * turn_y(90.0), 20.0);
}

/// A cart with two wheels, its shafts on the ground towards +x.
void add_cart(Mesh& mesh, const YardLooks& looks, const glm::dmat4& at) {
  const glm::dmat4 lean = at * move({0.0, 0.62, 0.0}) * turn_z(-9.0);
  add_part(mesh, box({-1.2, 0.0, -0.62}, {1.2, 0.07, 0.62}), looks.wood, lean);
  for (const double z : {-0.62, 0.57})
    add_part(mesh, box({-1.21, 0.072, z}, {1.21, 0.5, z + 0.05}), looks.wood, lean);
  add_part(mesh, box({-1.2, 0.075, -0.565}, {-1.15, 0.48, 0.565}), looks.wood, lean);
  for (const double z : {-0.4, 0.4})
    add_part(mesh, bar({1.0, 0.0, z}, {3.2, -0.12, z}, 0.06, 0.08), looks.timber, lean);
  for (const double z : {-0.8, 0.72}) {
    const glm::dmat4 wheel = at * move({-0.1, 0.6, z + 0.04}) * turn_x(90.0);
    add_part(mesh, ring({{0.5, -0.04}, {0.6, -0.04}, {0.6, 0.04}, {0.5, 0.04}}, 28), looks.timber,
             wheel, 40.0);
    add_part(mesh, cylinder(0.1, 0.1, 0.2, 12), looks.timber, wheel * move({0.0, -0.1, 0.0}), 40.0);
    for (int i = 0; i < 8; ++i)
      add_part(mesh, box({-0.02, -0.02, 0.06}, {0.02, 0.02, 0.54}), looks.timber,
               wheel * turn_y(45.0 * i + 7.0));
  }
}

void add_stones_and_wood(Mesh& mesh, const YardLooks& looks) {
  Random random(12);
  const double stones[11][3] = {{-7.5, 7.2, 0.5},  {-8.6, 6.3, 0.8}, {-6.9, 8.0, 0.3},
                                {7.6, 8.4, 0.45},  {8.9, 7.6, 0.7},  {2.2, 9.2, 0.25},
                                {-1.3, -1.6, 0.2}, {1.4, 3.2, 0.16}, {-3.6, 9.6, 0.4},
                                {10.6, 2.0, 0.5},  {-11.4, 1.5, 0.6}};
  for (std::uint32_t i = 0; i < 11; ++i)
    add_part(mesh, boulder(201 + i, 0.75, 14, 9), looks.stone,
             move({stones[i][0], 0.22 * stones[i][2], stones[i][1]}) *
                 turn_y(random.range(0.0, 360.0)) *
                 stretch({1.25 * stones[i][2], 0.8 * stones[i][2], stones[i][2]}),
             40.0);
  // Logs against the barn's wall.
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i + row < 7; ++i)
      add_part(mesh, cylinder(0.15, 0.14, random.range(1.0, 1.15), 9), looks.wood,
               move({2.6 + 0.31 * i + 0.155 * row, 0.14 + 0.265 * row, 1.15}) * turn_x(90.0) *
                   turn_y(random.range(0.0, 360.0)),
               40.0);
}

}  // namespace

/// Two houses and what stands in their yard, all of it one mesh: whatever is drawn for a part of
/// the scene draws the whole of it (Alecu 2014, 4).
Scene make_village() {
  SceneBuilder b("village", "Two houses around a yard");
  const YardLooks looks = {b.look("yard", {0.92f, 0.86f, 0.76f}, b.texture("sand", 111), 6.0),
                           b.look("stone", {0.95f, 0.93f, 0.90f}, b.texture("rock", 112), 1.6),
                           b.look("wood", {0.95f, 0.86f, 0.74f}, b.texture("wood", 113), 1.2),
                           b.look("timber", {0.42f, 0.30f, 0.20f}, b.texture("wood", 113), 1.2),
                           b.look("rope", {0.65f, 0.56f, 0.40f})};
  const Look roof = b.look("roof", {0.72f, 0.36f, 0.24f}, b.texture("tiles", 114), 1.6);
  const Look glass = b.look("glass", {0.10f, 0.14f, 0.18f}, -1, 1.0, 0.35f, 200.0f);
  const HouseLooks farm = {b.look("plaster", {0.90f, 0.86f, 0.78f}, b.texture("plaster", 115), 3.0),
                           roof, looks.timber, glass};
  const HouseLooks barn = {b.look("brick", {0.95f, 0.80f, 0.72f}, b.texture("brick", 116), 1.1),
                           roof, looks.timber, glass};
  const Look green = b.look("leaves", {0.90f, 0.97f, 0.78f}, b.texture("leaf", 117), 1.6);
  const Look bark = b.look("bark", {0.9f, 0.88f, 0.85f}, b.texture("bark", 118), 1.0);
  Mesh mesh;
  add_part(mesh, box({-26.0, -0.4, -24.0}, {26.0, 0.0, 18.0}), looks.ground);
  add_house(mesh, {.width = 11.0, .depth = 7.5, .storeys = 2, .pitch = 0.9, .fine = true}, farm,
            move({-6.5, 0.0, -6.0}) * turn_y(14.0));
  add_house(
      mesh,
      {.width = 8.5, .depth = 6.5, .storeys = 1, .pitch = 1.15, .chimney = false, .fine = true},
      barn, move({5.6, 0.0, -2.2}) * turn_y(-32.0));
  add_well(mesh, looks, roof, move({-0.6, 0.0, 4.2}) * turn_y(25.0));
  add_cart(mesh, looks, move({5.2, 0.0, 5.6}) * turn_y(-38.0));
  add_stones_and_wood(mesh, looks);
  for (const glm::dvec2 at : {glm::dvec2(-3.1, 1.2), glm::dvec2(-3.9, 1.5), glm::dvec2(-3.3, 2.1)})
    append(mesh, make_barrel(looks.wood), move({at.x, 0.0, at.y}));
  add_fence(mesh, {-15.0, 0.0, 6.0}, {-9.4, 0.0, 11.0}, looks.wood);
  add_fence(mesh, {-9.0, 0.0, 11.2}, {-3.2, 0.0, 12.2}, looks.wood);
  add_fence(mesh, {5.0, 0.0, 12.3}, {13.0, 0.0, 9.0}, looks.wood);
  append(mesh, make_tree(bark, green, 21), move({-13.5, 0.0, 1.0}) * stretch(glm::dvec3(1.15)));
  append(mesh, make_tree(bark, green, 22), move({11.5, 0.0, -6.5}) * stretch(glm::dvec3(1.3)));
  gather_materials(mesh);
  b.place(b.add_mesh("village", std::move(mesh)), glm::dmat4(1.0));
  b.scene.receivers.push_back(
      {"yard", {{-26.0, 0.0, -24.0}, {-26.0, 0.0, 18.0}, {26.0, 0.0, 18.0}, {26.0, 0.0, -24.0}}});
  b.sun({0.80, -0.62, -0.10}, {1.0f, 0.94f, 0.82f}, 1.2f);
  b.camera("main", {2.4, 6.4, 17.5}, {-0.8, 1.7, -0.6}, 47.0);
  b.camera("yard", {4.2, 1.7, 12.5}, {-2.2, 1.9, -2.0}, 52.0);
  add_sky(b.scene);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
