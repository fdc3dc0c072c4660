#include <gtest/gtest.h>

#include <cmath>

#include "renderer/scene/transforms.h"

namespace penumbra {
namespace {

// From 10 m straight down, near plane at 1 m, 4 m wide and 2 m high.
Camera from_above() {
  Camera camera;
  camera.position = {3.0, 10.0, 0.0};
  camera.target = {3.0, 0.0, 0.0};
  camera.up = {0.0, 0.0, -1.0};
  camera.projection = Projection::orthographic;
  camera.orthographic_height = 2.0;
  camera.near_plane = 1.0;
  return camera;
}

/// Where the depth of a parallel view from above ends, m below its near plane; depth falls from 1
/// to 0 evenly.
double end_of(const std::vector<Bounds>& boxes, const glm::dvec3& origin = {}) {
  const CameraMatrices matrices = matrices_seeing(from_above(), origin, 2.0, boxes);
  const auto depth_at = [&](double y) {
    return (matrices.clip_from_world * glm::dvec4(glm::dvec3(3.0, y, 0.0) - origin, 1.0)).z;
  };
  const double fall = depth_at(1.0) - depth_at(0.0);
  return 10.0 + depth_at(0.0) / fall;
}

TEST(MatricesSeeing, end_one_part_in_a_hundred_behind_the_farthest_that_is_seen) {
  const Bounds ground{{-50.0, -2.0, -50.0}, {50.0, 0.0, 50.0}};
  EXPECT_NEAR(end_of({ground}), 12.0 + 0.01 * 2.0, 1e-9);
  EXPECT_NEAR(end_of({{{2.9, 3.0, -0.1}, {3.1, 4.0, 0.1}}}), 7.0 + 0.01, 1e-9);
}

TEST(MatricesSeeing, know_nothing_of_what_is_out_of_sight) {
  const Bounds ground{{-50.0, -2.0, -50.0}, {50.0, 0.0, 50.0}};
  const Bounds aside{{5.1, -1e8, -1.0}, {6.0, -1e8, 1.0}},
      above{{-9.0, 20.0, -9.0}, {9.0, 30.0, 9.0}};
  EXPECT_NEAR(end_of({ground, aside}), 12.0 + 0.01 * 2.0, 1e-9);
  EXPECT_NEAR(end_of({aside}), 1.0 + 1.0, 1e-9);
  EXPECT_NEAR(end_of({aside, above}), 1.0 + 1.0, 1e-9);
  EXPECT_NEAR(end_of({}), 1.0 + 1.0, 1e-9);
}

TEST(MatricesSeeing, count_from_the_origin_of_the_device) {
  const Bounds ground{{-50.0, -2.0, -50.0}, {50.0, 0.0, 50.0}};
  const glm::dvec3 origin(1e3, -3e2, 2e3);
  EXPECT_NEAR(end_of({{ground.low - origin, ground.high - origin}}, origin), 12.0 + 0.0225, 2e-3);
}

/// Depth of a point as a device has it.
float drawn_depth(const CameraMatrices& matrices, const glm::dvec3& point) {
  const glm::vec4 clip = glm::mat4(matrices.clip_from_world) * glm::vec4(point, 1.0f);
  return clip.z / clip.w;
}

Camera from_afar(double distance) {
  Camera camera;
  camera.position = {0.0, 0.0, distance};
  camera.target = {0.0, 0.0, 0.0};
  camera.vertical_fov = glm::degrees(2.0 * std::atan(2.0 / distance));
  camera.near_plane = 0.1;
  return camera;
}

TEST(MatricesSeeing, tell_a_hundredth_of_a_millimetre_apart_from_a_hundred_kilometres) {
  const double distance = 1e5;
  const Bounds room{{-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}};
  const CameraMatrices fitted = matrices_seeing(from_afar(distance), {}, 1.0, {room});
  EXPECT_TRUE(fitted.ends);
  for (double z = -5.0; z < 5.0; z += 0.37) {
    const float here = drawn_depth(fitted, {0.3, -0.2, z});
    const float nearer = drawn_depth(fitted, {0.3, -0.2, z + 1e-5});
    EXPECT_GT(nearer, here) << z;
    EXPECT_GT(here, 0.0f);
    EXPECT_LT(nearer, 1.0f);
  }
  // Depth n (f - z) / (z (f - n)) of the near plane n is 1.
  const glm::dvec3 near(0.0, 0.0, distance - fitted.near_plane);
  const glm::dvec4 clip = fitted.clip_from_world * glm::dvec4(near, 1.0);
  EXPECT_NEAR(clip.z / clip.w, 1.0, 1e-9);
}

TEST(MatricesSeeing, look_where_the_camera_does_whatever_becomes_of_depth) {
  const Camera camera = from_afar(1e5);
  const CameraMatrices plain = camera_matrices(camera, {}, 1.0, 1.0);
  const CameraMatrices fitted =
      matrices_seeing(camera, {}, 1.0, {{{-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}}});
  const glm::dvec4 point(1.0, -0.5, 2.0, 1.0);
  const glm::dvec4 a = plain.clip_from_world * point, b = fitted.clip_from_world * point;
  for (int axis : {0, 1, 3}) EXPECT_NEAR(a[axis], b[axis], 1e-9);
  const glm::dvec3 through(plain.world_from_clip * glm::dvec4(0.4, 0.7, 0.0, 1.0));
  const glm::dvec3 same(fitted.world_from_clip * glm::dvec4(0.4, 0.7, 0.0, 1.0));
  EXPECT_LT(glm::length(glm::normalize(through) - glm::normalize(same)), 1e-12);
}

TEST(MatricesSeeing, keep_what_is_flat_wherever_coordinates_begin) {
  Camera camera = from_afar(0.04);
  camera.projection = Projection::orthographic;
  camera.orthographic_height = 1.0;
  camera.near_plane = 0.01;
  for (const double away : {0.0, 1.5, -100.0}) {
    const glm::dvec3 origin(0.0, 0.0, away);
    const Bounds flat{{-2.0, -2.0, 0.0}, {2.0, 2.0, 0.0}};
    const Bounds moved{flat.low - origin, flat.high - origin};
    const CameraMatrices fitted = matrices_seeing(camera, origin, 1.0, {moved});
    const float depth = drawn_depth(fitted, {0.25, -0.5, -away});
    EXPECT_GT(depth, 0.0f) << away;
    EXPECT_LT(depth, 1.0f) << away;
  }
}

TEST(MatricesSeeing, leave_cameras_within_the_scene_every_bit) {
  const Camera camera = from_afar(20.0);
  const Bounds room{{-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}};
  EXPECT_EQ(matrices_seeing(camera, {}, 1.0, {room}).clip_from_world,
            camera_matrices(camera, {}, 1.0, 1.0).clip_from_world);
  EXPECT_EQ(matrices_seeing(from_afar(1e5), {}, 1.0, {}).clip_from_world,
            camera_matrices(from_afar(1e5), {}, 1.0, 1.0).clip_from_world);
}

}  // namespace
}  // namespace penumbra
