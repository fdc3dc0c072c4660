#include "scenes/built_in/built_in.h"
#include "scenes/built_in/outdoors.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

struct WaterTowerLooks {
  Look tank, steel, roof;
};

void add_tank(Mesh& mesh, const WaterTowerLooks& looks) {
  add_part(mesh,
           lathe({{0.0, 7.0},
                  {0.9, 7.06},
                  {1.8, 7.4},
                  {2.35, 7.9},
                  {2.5, 8.4},
                  {2.5, 11.4},
                  {2.42, 11.5},
                  {0.0, 11.52}},
                 40),
           looks.tank, glm::dmat4(1.0), 40.0);
  add_part(mesh,
           lathe({{0.0, 11.45}, {2.75, 11.45}, {2.75, 11.55}, {0.25, 13.0}, {0.0, 13.05}}, 40),
           looks.roof, glm::dmat4(1.0), 30.0);
  add_part(mesh, sphere(0.2, 16, 10), looks.steel, move({0.0, 13.15, 0.0}), 60.0);
  for (const double y : {8.6, 9.9, 11.1})
    add_part(mesh,
             ring({{2.45, y - 0.05}, {2.55, y - 0.05}, {2.55, y + 0.05}, {2.45, y + 0.05}}, 40),
             looks.steel, glm::dmat4(1.0), 40.0);
  // A walkway around the tank, with a railing.
  add_part(mesh, ring({{2.4, 8.02}, {3.35, 8.02}, {3.35, 8.12}, {2.4, 8.12}}, 40), looks.steel,
           glm::dmat4(1.0), 40.0);
  for (const double y : {8.62, 9.1})
    add_part(mesh, torus(3.28, 0.03, 40, 6), looks.steel, move({0.0, y, 0.0}), 60.0);
  for (int i = 0; i < 24; ++i)
    add_part(mesh, cylinder(0.025, 0.025, 1.02, 6), looks.steel,
             turn_y(15.0 * i) * move({3.28, 8.1, 0.0}), 60.0);
}

/// Where a leg is at a height: six of them lean inwards.
glm::dvec3 leg_at(int leg, double y) {
  const glm::dvec2 c = circle(60.0 * leg + 10.0);
  const double reach = 3.4 - 1.15 * y / 8.0;
  return {reach * c.x, y, reach * c.y};
}

void add_legs(Mesh& mesh, const WaterTowerLooks& looks) {
  const double levels[4] = {0.15, 2.8, 5.4, 7.9};
  for (int leg = 0; leg < 6; ++leg) {
    add_part(mesh, tube({leg_at(leg, -0.1), leg_at(leg, 8.0)}, {0.13, 0.11}, 10), looks.steel,
             glm::dmat4(1.0), 60.0);
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 low = leg_at(leg, levels[i]), high = leg_at(leg, levels[i + 1]);
      const glm::dvec3 low_next = leg_at(leg + 1, levels[i]);
      const glm::dvec3 high_next = leg_at(leg + 1, levels[i + 1]);
      add_part(mesh, bar(low, high_next, 0.05, 0.06), looks.steel);
      add_part(mesh, bar(low_next, high, 0.05, 0.06), looks.steel);
      if (i < 2) add_part(mesh, bar(high, high_next, 0.08, 0.10), looks.steel);
    }
  }
  add_part(mesh, cylinder(0.32, 0.32, 7.2, 20), looks.steel, move({0.0, -0.05, 0.0}), 40.0);
  // A ladder along one leg.
  const glm::dvec3 aside(0.0, 0.0, 0.22), out(0.28, 0.0, 0.0);
  for (const double side : {-1.0, 1.0})
    add_part(mesh,
             tube({leg_at(0, 0.0) + side * aside + out, leg_at(0, 8.1) + side * aside + out + out},
                  {0.03, 0.03}, 6),
             looks.steel, glm::dmat4(1.0), 60.0);
  for (int i = 1; i < 27; ++i) {
    const double y = 0.3 * i;
    const glm::dvec3 middle = leg_at(0, y) + out + out * (y / 8.1);
    add_part(mesh, bar(middle - aside, middle + aside, 0.03, 0.03), looks.steel);
  }
}

}  // namespace

/// A tank on six braced legs under one spot lamp whose cone may be opened and closed: how far the
/// texels of a map reach depends on the cone alone (Sindholt 2005, figures 52 and 53).
Scene make_water_tower() {
  SceneBuilder b("water-tower", "A water tower at night");
  const Look ground = b.look("ground", {0.86f, 0.84f, 0.80f}, b.texture("concrete", 131), 5.0);
  const WaterTowerLooks looks = {
      b.look("tank", {0.74f, 0.80f, 0.82f}, b.texture("painted_metal", 132), 2.0, 0.08f, 50.0f),
      b.look("steel", {0.44f, 0.45f, 0.46f}, b.texture("painted_metal", 133), 1.5, 0.12f, 60.0f),
      b.look("roof", {0.58f, 0.22f, 0.16f}, b.texture("corrugated", 134), 1.6, 0.06f, 30.0f)};
  const Look footing = b.look("footing", {0.92f, 0.90f, 0.86f}, b.texture("plaster", 135), 2.0);
  b.ground({-26.0, -30.0}, {26.0, 22.0}, ground, "yard", 0.4);
  Mesh mesh;
  add_tank(mesh, looks);
  add_legs(mesh, looks);
  for (int leg = 0; leg < 6; ++leg) {
    const glm::dvec3 foot = leg_at(leg, 0.0);
    add_part(mesh, rounded_box({-0.45, -0.1, -0.45}, {0.45, 0.3, 0.45}, 0.04, 1), footing,
             move({foot.x, 0.0, foot.z}) * turn_y(-60.0 * leg - 10.0));
  }
  gather_materials(mesh);
  b.place(b.add_mesh("water tower", std::move(mesh)), glm::dmat4(1.0));
  b.spot("lamp", {13.0, 19.0, 15.0}, {-3.0, 2.6, -3.4}, {1.0f, 0.94f, 0.82f}, 1.3f, 38.0,
         disc(0.25));
  b.camera("main", {-7.0, 9.6, 22.5}, {-1.2, 5.0, -2.0}, 44.0);
  b.scene.ambient = {0.12f, 0.13f, 0.16f};
  b.scene.background_low = {0.20f, 0.25f, 0.34f};
  b.scene.background_high = {0.05f, 0.08f, 0.16f};
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
