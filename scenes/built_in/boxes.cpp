#include <string>

#include "scenes/built_in/built_in.h"
#include "scenes/generators/random.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {

/// 50 boxes on a grey plane, the camera further away, one area light far above.
Scene make_boxes() {
  SceneBuilder b("boxes", "Fifty boxes on a grey plane");
  const int wood = b.texture("wood", 3), cardboard = b.texture("cardboard", 4);
  const int paint = b.texture("painted_metal", 5);
  const Look looks[6] = {b.look("crate", {0.95f, 0.90f, 0.82f}, wood, 1.2),
                         b.look("cardboard", {1.0f, 0.97f, 0.92f}, cardboard, 1.0),
                         b.look("red paint", {0.62f, 0.13f, 0.10f}, paint, 1.5, 0.06f, 40.0f),
                         b.look("blue paint", {0.14f, 0.28f, 0.48f}, paint, 1.5, 0.06f, 40.0f),
                         b.look("white paint", {0.80f, 0.79f, 0.75f}, paint, 1.5, 0.06f, 40.0f),
                         b.look("ochre paint", {0.76f, 0.52f, 0.16f}, paint, 1.5, 0.06f, 40.0f)};
  const Look grey = b.look("grey ground", {0.80f, 0.80f, 0.80f}, b.texture("concrete", 2), 6.0);
  b.ground({-44.0, -44.0}, {44.0, 44.0}, grey);

  // Eight columns by seven rows of cells less six at the corners; each box is turned and moved
  // within its cell, so that none overlaps.
  Random random(50);
  int count = 0;
  for (int cell = 0; cell < 56; ++cell) {
    const int column = cell % 8, row = cell / 8;
    const bool corner = (column == 0 || column == 7) && (row == 0 || row == 6);
    if (corner || cell == 1 || cell == 54) continue;
    const double width = random.range(0.7, 1.3), depth = random.range(0.7, 1.3);
    const double height = count % 7 == 3 ? random.range(2.0, 3.1) : random.range(0.5, 1.6);
    const double x = (column - 3.5) * 1.95 + random.range(-0.2, 0.2);
    const double z = (row - 3.0) * 2.05 + random.range(-0.25, 0.25);
    const Look& look = looks[random.below(6)];
    const double angle = random.range(-40.0, 40.0);
    b.place(rounded_box({-0.5 * width, 0.0, -0.5 * depth}, {0.5 * width, height, 0.5 * depth},
                        0.025, 1),
            look, "box " + std::to_string(++count), move({x, 0.0, z}) * turn_y(angle), 20.0);
  }
  b.spot("lamp", {-9.0, 24.0, 7.0}, {0.0, 0.0, 0.0}, {1.0f, 0.96f, 0.89f}, 1.15f, 45.0,
         rectangle(2.4, 2.4))
      .inner_angle = 24.0;
  b.camera("main", {6.4, 14.2, 16.4}, {0.0, 0.2, -0.3}, 43.0);
  b.scene.ambient = {0.13f, 0.14f, 0.16f};
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
