// Exposure of lights in physical units: what the first camera sees decides.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/generators/scene_builder.h"
#include "scenes/import/gltf.h"

namespace penumbra::scenes {
namespace {

/// A box on a ground of this half size, a lamp of 80 cd beside it, and a camera that looks at both.
Scene lamp_over_ground(double half) {
  SceneBuilder b("lamp", "A lamp over the ground");
  const Look grey = b.look("grey", glm::vec3(0.7f));
  b.ground({-half, -half}, {half, half}, grey);
  b.place(box({-0.5, 0.0, -0.2}, {0.5, 1.0, 0.2}), grey, "box");
  Light& lamp = b.spot("lamp", {-2.0, 4.0, 2.5}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 80.0f, 45.0, {});
  lamp.kind = LightKind::point;
  lamp.attenuation = Attenuation::inverse_square;
  b.camera("main", {2.5, 3.0, 5.0}, {0.0, 0.5, 0.0}, 40.0);
  return b.scene;
}

double exposure_of(Scene scene) {
  gltf::expose(scene);
  return static_cast<double>(scene.exposure);
}

/// A box far outside of the picture.
void add_far_box(Scene& scene, double distance) {
  Instance moon = scene.instances.back();
  moon.name = "moon";
  moon.world_from_object[3] = glm::dvec4(0.6 * distance, 0.6 * distance, -0.6 * distance, 1.0);
  scene.instances.push_back(moon);
}

TEST(Exposure, OfASunIsThatOfItsIlluminance) {
  Scene scene = lamp_over_ground(6.0);
  scene.cameras[0].position = {0.0, 9.0, 0.0};
  scene.cameras[0].target = {0.0, 0.0, 0.0};
  scene.cameras[0].up = {0.0, 0.0, -1.0};
  scene.lights[0].kind = LightKind::directional;
  scene.lights[0].direction = glm::normalize(glm::dvec3(1.0, -1.0, 0.0));
  scene.lights[0].intensity = 50000.0f;
  // The camera sees level surfaces alone: lux times the cosine of 45 degrees.
  EXPECT_NEAR(exposure_of(scene) * 50000.0 * std::sqrt(0.5), 1.2, 1e-4);
}

TEST(Exposure, OfALampLeavesItsBrightestSpotNearWhite) {
  // 80 cd from 4 m are 5 lux right below the lamp, the most that the ground gets.
  const double white = exposure_of(lamp_over_ground(6.0)) * 5.0;
  EXPECT_GT(white, 1.0);
  EXPECT_LT(white, 1.6);
}

TEST(Exposure, DoesNotFollowTheSizeOfTheGround) {
  const double small = exposure_of(lamp_over_ground(6.0));
  for (const double half : {30.0, 100.0, 1000.0, 1e5})
    EXPECT_NEAR(exposure_of(lamp_over_ground(half)) / small, 1.0, 0.05) << half;
}

TEST(Exposure, DoesNotFollowWhatTheCameraDoesNotSee) {
  Scene scene = lamp_over_ground(6.0);
  const double alone = exposure_of(scene);
  for (const double distance : {1e3, 1e6, 3.8e8}) {
    Scene with_moon = scene;
    add_far_box(with_moon, distance);
    EXPECT_EQ(exposure_of(with_moon), alone) << distance;
  }
  // Behind the camera, right under a lamp of its own that does not reach what is seen.
  Light second = scene.lights[0];
  second.name = "second";
  second.position = {80.0, 4.0, 80.0};
  scene.lights.push_back(second);
  EXPECT_NEAR(exposure_of(scene) / alone, 1.0, 0.01);
}

TEST(Exposure, ShowsWhatIsSeenWhereNoLightFallsOnIt) {
  Scene scene = lamp_over_ground(6.0);
  scene.lights[0].position.y = -4.0;
  const double exposure = exposure_of(scene);
  EXPECT_GT(exposure, 1e-3);
  EXPECT_LT(exposure, 10.0);
}

TEST(Exposure, IsSaidInEV) {
  Scene scene = lamp_over_ground(6.0);
  gltf::expose(scene);
  bool said = false;
  for (const std::string& note : scene.notes) said |= note.find(" EV") != std::string::npos;
  EXPECT_TRUE(said);
}

}  // namespace
}  // namespace penumbra::scenes
