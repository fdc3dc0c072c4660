#include <gtest/gtest.h>

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

double depth_of(const std::vector<Bounds>& boxes) {
  return seen_depth(from_above(), glm::dvec3(0.0), 2.0, boxes);
}

TEST(SeenDepth, reaches_one_part_in_a_hundred_beyond_the_farthest_that_is_seen) {
  const Bounds ground{{-50.0, -2.0, -50.0}, {50.0, 0.0, 50.0}};
  EXPECT_NEAR(depth_of({ground}), 1.01 * 11.0, 1e-9);
  EXPECT_NEAR(depth_of({{{2.9, 3.0, -0.1}, {3.1, 4.0, 0.1}}}), 1.01 * 6.0, 1e-9);
}

TEST(SeenDepth, knows_nothing_of_what_is_out_of_sight) {
  const Bounds ground{{-50.0, 0.0, -50.0}, {50.0, 0.0, 50.0}};
  const Bounds aside{{5.1, -1e8, -1.0}, {6.0, -1e8, 1.0}},
      above{{-9.0, 20.0, -9.0}, {9.0, 30.0, 9.0}};
  EXPECT_NEAR(depth_of({ground, aside, above}), 1.01 * 9.0, 1e-9);
  EXPECT_EQ(depth_of({aside, above}), 1.0);
  EXPECT_EQ(depth_of({}), 1.0);
}

TEST(SeenDepth, counts_from_the_origin_of_the_device) {
  const Bounds ground{{-50.0, 0.0, -50.0}, {50.0, 0.0, 50.0}};
  const glm::dvec3 origin(1e6, -3e5, 2e6);
  EXPECT_NEAR(seen_depth(from_above(), origin, 2.0, {{ground.low - origin, ground.high - origin}}),
              1.01 * 9.0, 1e-6);
}

}  // namespace
}  // namespace penumbra
