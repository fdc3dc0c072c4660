#include "scenes/built_in/built_in.h"
#include "scenes/generators/random.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {

/// An edge along z over the plane y = 0, under a square light: with occluder height h = 1 m, light
/// height H = 4 m and light width w = 1 m, the penumbra on the plane is w h / (H - h) = 1/3 m wide
/// and the visible share of the light falls linearly across it. The lower edge of the plate is the
/// one that counts for x > 0 of the light; the plate is 1 mm thin, so that both agree within 0.4
/// mm.
Scene make_half_plane() {
  SceneBuilder b("half-plane", "Straight edge over a plane");
  const Look white = b.look("receiver", glm::vec3(0.8f));
  const Look dark = b.look("edge", glm::vec3(0.5f));
  b.ground({-6.0, -6.0}, {6.0, 6.0}, white, "plane");
  b.place(box({-4.0, 0.9995, -5.0}, {0.0, 1.0005, 5.0}), dark, "edge");
  Light& light = b.spot("square", {0.0, 4.0, 0.0}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 60.0,
                        rectangle(1.0, 1.0));
  light.inner_angle = 59.0;
  b.camera("main", {0.0, 0.8, 0.0}, {0.0, 0.0, 0.0}, 60.0).up = {0.0, 0.0, -1.0};
  Camera& camera = b.scene.cameras.back();
  camera.near_plane = 0.01;
  b.camera("wide", {7.0, 5.0, 8.0}, {0.0, 0.4, 0.0}, 45.0);
  b.scene.ambient = glm::vec3(0.0f);
  return std::move(b.scene);
}

/// Three plates above each other, each half over the next: light bleeds where variances add up.
Scene make_three_layers() {
  SceneBuilder b("three-layers", "Three plates above each other");
  const Look ground = b.look("ground", {0.75f, 0.75f, 0.75f}, b.texture("concrete", 6), 3.0);
  const Look looks[3] = {b.look("low plate", {0.70f, 0.45f, 0.35f}),
                         b.look("middle plate", {0.42f, 0.58f, 0.45f}),
                         b.look("high plate", {0.40f, 0.48f, 0.66f})};
  b.ground({-5.0, -5.0}, {5.0, 5.0}, ground);
  for (int i = 0; i < 3; ++i) {
    const double y = 0.3 + 0.9 * i, x = -0.9 + 0.6 * i;
    b.place(box({x - 0.9, y, -1.2 + 0.3 * i}, {x + 0.9, y + 0.05, 0.9 + 0.3 * i}), looks[i],
            b.scene.materials[looks[i].material].name);
  }
  b.spot("lamp", {1.5, 6.0, 1.0}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 35.0, disc(0.25));
  b.camera("main", {3.2, 3.4, 4.6}, {0.0, 0.7, 0.0}, 42.0);
  return std::move(b.scene);
}

/// Boxes that touch the ground along an edge, on a corner and with a whole side: bias detaches the
/// shadow from what casts it.
Scene make_contact() {
  SceneBuilder b("contact", "Objects that touch the ground");
  const Look ground = b.look("ground", {0.78f, 0.77f, 0.74f}, b.texture("tiles", 8), 2.0);
  const Look wood = b.look("wood", {1.0f, 0.95f, 0.9f}, b.texture("wood", 9), 1.0);
  const Look metal = b.look("metal", {0.55f, 0.57f, 0.60f}, -1, 1.0, 0.2f, 80.0f);
  b.ground({-4.0, -4.0}, {4.0, 4.0}, ground);
  b.place(box({-0.4, 0.0, -0.4}, {0.4, 0.8, 0.4}), wood, "standing", move({-1.1, 0.0, 0.2}));
  // Half the diagonal of a 0.6 m square is 0.42426 m.
  b.place(box({-0.3, -0.3, -0.5}, {0.3, 0.3, 0.5}), metal, "on its edge",
          move({0.2, 0.424264, 0.5}) * turn_y(25.0) * turn_z(45.0));
  b.place(cylinder(0.02, 0.02, 1.2, 16), metal, "rod", move({1.2, 0.0, -0.3}));
  b.place(sphere(0.3, 48, 24), wood, "ball", move({1.0, 0.3, 0.9}));
  b.spot("lamp", {3.0, 3.2, 2.0}, {0.0, 0.0, 0.2}, {1.0f, 0.97f, 0.92f}, 1.2f, 32.0, disc(0.15));
  b.camera("main", {0.4, 1.9, 3.6}, {0.05, 0.35, 0.1}, 42.0);
  return std::move(b.scene);
}

/// A closed dark room with thin walls under a bright light: any light inside is a leak.
Scene make_leaky_box() {
  SceneBuilder b("leaky-box", "Closed room that must stay dark");
  const Look ground = b.look("ground", {0.75f, 0.75f, 0.75f}, b.texture("concrete", 10), 3.0);
  const Look wall = b.look("wall", glm::vec3(0.8f), b.texture("plaster", 11), 2.0);
  b.ground({-6.0, -6.0}, {6.0, 6.0}, ground);
  const double h = 2.0, t = 0.02;  // inner half width and wall thickness
  b.place(box({-h - t, 0.0, -h - t}, {-h, 2.4, h + t}), wall, "west wall");
  b.place(box({h, 0.0, -h - t}, {h + t, 2.4, h + t}), wall, "east wall");
  b.place(box({-h, 0.0, -h - t}, {h, 2.4, -h}), wall, "north wall");
  b.place(box({-h, 0.0, h}, {h, 2.4, h + t}), wall, "south wall");
  b.place(box({-h - t, 2.4, -h - t}, {h + t, 2.4 + t, h + t}), wall, "roof");
  b.spot("lamp", {5.0, 7.0, 3.0}, {0.0, 1.0, 0.0}, glm::vec3(1.0f), 1.0f, 40.0, disc(0.4));
  Camera& inside = b.camera("main", {1.8, 1.6, 1.8}, {-0.6, 0.8, -0.8}, 70.0);
  inside.near_plane = 0.05;
  b.camera("outside", {7.0, 5.0, 7.5}, {0.0, 0.8, 0.0}, 42.0);
  return std::move(b.scene);
}

/// The camera stands in the shadow of a wall: a count of volumes along the ray starts inside one.
Scene make_camera_in_volume() {
  SceneBuilder b("camera-in-volume", "Camera inside a shadow volume");
  const Look ground = b.look("ground", {0.72f, 0.73f, 0.70f}, b.texture("concrete", 12), 3.0);
  const Look wall = b.look("wall", {0.9f, 0.9f, 0.9f}, b.texture("brick", 13), 1.2);
  const Look wood = b.look("wood", {1.0f, 0.95f, 0.9f}, b.texture("wood", 14), 1.0);
  b.ground({-12.0, -12.0}, {12.0, 12.0}, ground);
  b.place(box({-4.0, 0.0, 2.0}, {4.0, 3.5, 2.3}), wall, "wall behind the camera");
  for (int i = 0; i < 5; ++i)
    b.place(box({-0.25, 0.0, -0.25}, {0.25, 1.4, 0.25}), wood, "post " + std::to_string(i + 1),
            move({-3.0 + 1.5 * i, 0.0, -3.2 - 0.4 * (i % 2)}) * turn_y(20.0 * i));
  b.spot("lamp", {0.0, 7.0, 9.0}, {0.0, 0.0, -2.0}, {1.0f, 0.97f, 0.9f}, 1.1f, 45.0, disc(0.3));
  b.camera("main", {0.4, 1.5, 1.6}, {0.0, 0.5, -3.0}, 60.0);
  b.camera("side", {9.0, 5.0, 4.0}, {0.0, 0.5, -1.0}, 50.0);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
