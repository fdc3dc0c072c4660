#include "scenes/built_in/car_parts.h"

#include "scenes/built_in/built_in.h"
#include "scenes/built_in/studio.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {

/// A car on a box under two area lights close above it.
Scene make_car() {
  SceneBuilder b("car", "A car on a box");
  const Look floor = b.look("studio floor", {0.80f, 0.80f, 0.79f}, b.texture("plaster", 71), 4.0);
  const Look top = b.look("box", {0.92f, 0.90f, 0.86f}, b.texture("wood", 72), 1.6);
  add_studio(b, floor, 14.0, 4.2, 7.0, 2.5, 9.0);
  b.place(rounded_box({-2.75, 0.0, -1.55}, {2.75, 0.55, 1.55}, 0.03, 2), top, "box", turn_y(-33.0));
  b.scene.receivers.push_back({"box top", {}});
  for (const glm::dvec2& c : {glm::dvec2(-2.72, -1.52), glm::dvec2(-2.72, 1.52),
                              glm::dvec2(2.72, 1.52), glm::dvec2(2.72, -1.52)})
    b.scene.receivers.back().corners.emplace_back(turn_y(-33.0) * glm::dvec4(c.x, 0.55, c.y, 1.0));
  const CarLooks looks = {b.look("paint", {0.55f, 0.045f, 0.04f}, -1, 1.0, 0.10f, 160.0f),
                          b.look("glass", {0.045f, 0.06f, 0.07f}, -1, 1.0, 0.22f, 260.0f),
                          b.look("chrome", {0.62f, 0.63f, 0.65f}, -1, 1.0, 0.30f, 120.0f),
                          b.look("rubber", {0.045f, 0.045f, 0.045f}, -1, 1.0, 0.05f, 16.0f),
                          b.look("lamp", {0.90f, 0.88f, 0.80f}, -1, 1.0, 0.30f, 200.0f),
                          b.look("tail lamp", {0.65f, 0.05f, 0.03f}, -1, 1.0, 0.25f, 120.0f)};
  b.place(b.add_mesh("car", make_car_mesh(looks)), move({0.0, 0.55, 0.0}) * turn_y(-33.0));
  b.spot("left lamp", {-1.7, 4.0, 2.2}, {0.0, 0.6, 0.0}, {1.0f, 0.93f, 0.82f}, 0.66f, 68.0,
         disc(0.45))
      .inner_angle = 22.0;
  b.spot("right lamp", {2.7, 3.7, 1.0}, {0.0, 0.6, 0.0}, {0.86f, 0.93f, 1.0f}, 0.54f, 68.0,
         disc(0.40))
      .inner_angle = 22.0;
  b.camera("main", {1.3, 2.75, 7.0}, {0.10, 0.66, 0.0}, 39.0);
  b.scene.ambient = glm::vec3(0.11f);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
