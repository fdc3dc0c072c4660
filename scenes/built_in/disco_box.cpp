#include "scenes/built_in/built_in.h"
#include "scenes/built_in/studio.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

/// Crate of boards in a frame of bars, 1 m wide and 0.9 m high, its base at y = 0.
Mesh make_crate(const Look& boards, const Look& frame) {
  Mesh mesh;
  const double half = 0.5, height = 0.9, bar_width = 0.1, inset = 0.035;
  add_part(mesh,
           box({-half + inset, 0.01, -half + inset}, {half - inset, height - 0.02, half - inset}),
           boards);
  // Four posts and, between them above and below, rails on all sides.
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0}) {
      const glm::dvec3 corner(x * (half - 0.5 * bar_width), 0.0, z * (half - 0.5 * bar_width));
      add_part(mesh,
               rounded_box(corner - glm::dvec3(0.5 * bar_width, 0.0, 0.5 * bar_width),
                           corner + glm::dvec3(0.5 * bar_width, height, 0.5 * bar_width), 0.008, 1),
               frame, glm::dmat4(1.0), 20.0);
    }
  for (int side = 0; side < 4; ++side)
    for (const double y : {0.006, height - bar_width - 0.006})
      add_part(mesh,
               rounded_box({-half + bar_width - 0.01, y, half - 0.07},
                           {half - bar_width + 0.01, y + bar_width, half - 0.006}, 0.006, 1),
               frame, turn_y(90.0 * side), 20.0);
  // A slanted brace on each side.
  for (int side = 0; side < 4; ++side)
    add_part(mesh,
             bar({-0.40, 0.12, half - 0.03}, {0.40, height - 0.12, half - 0.03}, 0.03, 0.09,
                 {0.0, 1.0, 0.0}),
             frame, turn_y(90.0 * side), 20.0);
  return mesh;
}

}  // namespace

/// One box and three near area lights: red, green and blue.
Scene make_disco_box() {
  SceneBuilder b("disco-box", "A box under red, green and blue lights");
  const int wood = b.texture("wood", 21);
  const Look boards = b.look("boards", {0.95f, 0.92f, 0.88f}, wood, 0.7);
  const Look frame = b.look("frame", {1.0f, 0.97f, 0.92f}, b.texture("wood", 22), 0.9);
  const Look floor = b.look("floor", {0.86f, 0.86f, 0.86f}, b.texture("plaster", 23), 3.0);
  add_studio(b, floor, 9.0, 3.2, 3.4, 1.6);
  b.place(b.add_mesh("crate", make_crate(boards, frame)), turn_y(28.0));

  const glm::vec3 colors[3] = {{1.0f, 0.10f, 0.06f}, {0.07f, 0.95f, 0.12f}, {0.12f, 0.20f, 1.0f}};
  const char* names[3] = {"red", "green", "blue"};
  const glm::dvec3 positions[3] = {{-1.75, 2.15, 1.05}, {0.15, 2.45, 1.75}, {1.85, 2.2, 0.75}};
  for (int i = 0; i < 3; ++i)
    b.spot(names[i], positions[i], {0.0, 0.2, -0.1}, colors[i], 0.92f, 66.0, disc(0.22))
        .inner_angle = 12.0;
  b.camera("main", {0.5, 2.55, 4.1}, {0.05, 0.30, -0.15}, 40.0);
  b.scene.ambient = glm::vec3(0.07f);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
