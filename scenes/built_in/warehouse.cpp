#include <string>

#include "scenes/built_in/built_in.h"
#include "scenes/built_in/warehouse_parts.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {

/// The hall from within, under one area light that hangs above the trusses' tie beams.
Scene make_warehouse_inside() {
  SceneBuilder b("warehouse-inside", "A warehouse from inside");
  const Look floor = b.look("floor", {0.86f, 0.86f, 0.84f}, b.texture("concrete", 50), 5.0);
  b.ground({-16.0, -10.0}, {16.0, 10.0}, floor, "floor", 0.3);
  add_hall(b);
  add_goods(b);
  const Look rubber = b.look("rubber", {0.05f, 0.05f, 0.05f});
  const Look red = b.look("red metal", {0.60f, 0.10f, 0.08f}, -1, 1.0, 0.15f, 60.0f);
  b.place(b.add_mesh("hand truck", make_hand_truck(red, rubber)),
          move({-0.9, 0.0, 3.6}) * turn_y(-40.0));
  add_crane(b);
  b.spot("hall lamp", {6.2, 6.3, 1.6}, {1.6, 0.0, -0.4}, {1.0f, 0.93f, 0.80f}, 1.15f, 74.0,
         rectangle(0.9, 0.9));
  b.camera("main", {10.2, 3.3, 7.6}, {-2.6, 1.5, -2.4}, 52.0);
  b.scene.ambient = {0.15f, 0.16f, 0.18f};
  b.scene.background_low = {0.62f, 0.74f, 0.86f};
  b.scene.background_high = {0.45f, 0.62f, 0.85f};
  return std::move(b.scene);
}

/// The hall in its yard; camera and light are far away and close to each other.
Scene make_warehouse_outside() {
  SceneBuilder b("warehouse-outside", "A warehouse from outside");
  const Look asphalt = b.look("asphalt", {0.95f, 0.94f, 0.92f}, b.texture("asphalt", 60), 7.0);
  const Look meadow = b.look("meadow", {0.95f, 0.95f, 0.92f}, b.texture("grass", 66), 9.0);
  b.ground({-32.0, -19.0}, {34.0, 36.0}, asphalt, "yard", 0.3);
  b.place(box({-110.0, -0.5, -110.0}, {110.0, -0.06, 80.0}), meadow, "meadow");
  add_yard(b);
  add_hall(b);
  add_goods(b);
  const int paint = b.texture("painted_metal", 54);
  const Look dark = b.look("dark metal", {0.06f, 0.07f, 0.08f}, -1, 1.0, 0.2f, 90.0f);
  const Look rubber = b.look("rubber", {0.04f, 0.04f, 0.04f});
  const Look cab = b.look("cab", {0.68f, 0.14f, 0.10f}, paint, 2.0, 0.15f, 70.0f);
  const Look cargo = b.look("cargo", {0.82f, 0.82f, 0.80f}, paint, 3.0, 0.06f, 30.0f);
  b.place(b.add_mesh("lorry", make_lorry(cab, cargo, dark, rubber)),
          move({1.6, 0.0, 17.5}) * turn_y(24.0));
  // Freight containers beside the hall, lamp posts and a fence along the yard.
  const Look colors[3] = {b.look("container green", {0.16f, 0.36f, 0.28f},
                                 b.texture("corrugated", 62), 1.6, 0.06f, 30.0f),
                          b.look("container rust", {0.62f, 0.28f, 0.16f},
                                 b.texture("corrugated", 62), 1.6, 0.06f, 30.0f),
                          b.look("container blue", {0.20f, 0.36f, 0.58f},
                                 b.texture("corrugated", 62), 1.6, 0.06f, 30.0f)};
  const double containers[6][4] = {{21.5, 0.0, 4.0, 4.0},  {21.6, 2.605, 4.2, 2.0},
                                   {24.6, 0.0, 2.0, 8.0},  {-12.5, 0.0, 17.0, 96.0},
                                   {-20.5, 0.0, 6.0, 0.0}, {-20.7, 2.605, 6.1, -3.0}};
  for (int i = 0; i < 6; ++i)
    b.place(rounded_box({-1.22, 0.0, -3.03}, {1.22, 2.6, 3.03}, 0.05, 1), colors[(i * 2) % 3],
            "container " + std::to_string(i + 1),
            move({containers[i][0], containers[i][1], containers[i][2]}) * turn_y(containers[i][3]),
            20.0);
  const Look steel = b.look("galvanised", {0.55f, 0.57f, 0.58f}, -1, 1.0, 0.2f, 60.0f);
  Mesh post;
  add_part(post, cylinder(0.11, 0.07, 7.5, 12), steel, glm::dmat4(1.0), 40.0);
  add_part(post,
           tube({{0.0, 7.3, 0.0}, {0.0, 7.75, 0.3}, {0.0, 7.85, 1.3}}, {0.05, 0.05, 0.045}, 8),
           steel, glm::dmat4(1.0), 40.0);
  add_part(post, rounded_box({-0.16, 7.74, 1.1}, {0.16, 7.88, 1.9}, 0.04, 1), steel);
  const std::uint32_t lamp_post = b.add_mesh("lamp post", std::move(post));
  for (const double x : {-17.0, 0.0, 17.0})
    b.place(lamp_post, move({x + 6.0, 0.0, 27.0}) * turn_y(180.0));
  const std::uint32_t crate =
      b.add_mesh("yard crate",
                 make_slatted_crate(
                     b.look("yard wood", {0.95f, 0.92f, 0.86f}, b.texture("wood", 55), 1.2), 1.2));
  const double crates[6][4] = {{6.5, 0.0, 12.2, 14.0},   {8.0, 0.0, 12.6, -8.0},
                               {7.2, 1.205, 12.4, 30.0}, {9.6, 0.0, 12.0, 5.0},
                               {-5.5, 0.0, 13.0, 40.0},  {-7.2, 0.0, 12.4, 10.0}};
  for (const auto& c : crates) b.place(crate, move({c[0], c[1], c[2]}) * turn_y(c[3]));

  b.spot("flood light", {2.0, 52.0, 66.0}, {0.0, 0.0, 1.0}, {1.0f, 0.95f, 0.86f}, 1.2f, 33.0,
         disc(0.7))
      .inner_angle = 25.0;
  b.camera("main", {40.0, 36.0, 54.0}, {1.2, 1.0, 4.6}, 31.0);
  b.scene.ambient = {0.16f, 0.18f, 0.22f};
  b.scene.background_low = {0.62f, 0.74f, 0.86f};
  b.scene.background_high = {0.30f, 0.48f, 0.75f};
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
