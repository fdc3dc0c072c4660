#include <gtest/gtest.h>

#include <bit>

#include "scenes/library.h"
#include "tracer.h"

namespace penumbra::tests {
namespace embree_test {

constexpr std::uint32_t size = 128;

struct Verdict {
  std::size_t rays = 0;
  std::size_t hidden = 0;
  std::size_t different = 0;
};

/// Whether light from the centre comes here at all; elsewhere the mask is not read.
bool inside_light(const WorldLight& light, const glm::vec3& position) {
  if (light.source->kind != LightKind::spot) return true;
  const glm::dvec3 offset = glm::dvec3(position) - light.position;
  return glm::dot(glm::normalize(offset), light.direction) >
         std::cos(glm::radians(light.source->outer_angle));
}

/// Compares all rays from what the first camera sees to `count` points of every light.
Verdict compare(const std::shared_ptr<const Scene>& scene, std::uint32_t count) {
  Tracer tracer(scene);
  const GpuScene& gpu = tracer.scene();
  const Embree embree(gpu);
  const CameraMatrices camera = camera_matrices(scene->cameras.front(), gpu.origin(), 1.0, 1.0);
  const std::vector<Receiver> receivers = embree.receivers(camera, size);
  Verdict verdict;
  for (const Light& light : scene->lights) {
    const WorldLight world = world_light(light, gpu.origin());
    const std::vector<glm::vec4> points = light_points(world, count, 1, 3, false);
    const auto masks = tracer.masks(light, receivers, size, points);
    const float finite = light.kind == LightKind::directional ? 0.0f : 1.0f;
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      if (!receivers[r].surface || !inside_light(world, receivers[r].position)) continue;
      for (std::size_t p = 0; p < points.size(); ++p) {
        const float rounding = reference::rounding_of(gpu, receivers[r].position, camera.position);
        const bool truth =
            embree.hidden(receivers[r], rounding, glm::vec4(glm::vec3(points[p]), finite));
        const bool found = (masks[p / 32][r] >> (p % 32) & 1u) != 0;
        ++verdict.rays;
        verdict.hidden += truth;
        verdict.different += found != truth;
      }
    }
  }
  EXPECT_EQ(tracer.unfinished(), 0u);
  return verdict;
}

void expect_agreement(const Verdict& verdict) {
  ::testing::Test::RecordProperty("rays", static_cast<int>(verdict.rays));
  ::testing::Test::RecordProperty("different", static_cast<int>(verdict.different));
  EXPECT_GT(verdict.rays, 100000u);
  // A comparison where all rays fare alike would show nothing.
  EXPECT_GT(verdict.hidden, verdict.rays / 100);
  EXPECT_LT(verdict.hidden, verdict.rays * 99 / 100);
  // One in a million, and one more where there are fewer rays than that.
  EXPECT_LE(verdict.different, 1 + verdict.rays / 1000000) << "of " << verdict.rays << " rays";
}

TEST(OcclusionMask, AgreesWithEmbreeOnManyBoxes) {
  expect_agreement(compare(scenes::load("boxes"), 64));
}

TEST(OcclusionMask, AgreesWithEmbreeInsideAWarehouse) {
  expect_agreement(compare(scenes::load("warehouse-inside"), 64));
}

TEST(OcclusionMask, AgreesWithEmbreeOnFineMeshes) {
  expect_agreement(compare(scenes::load("car"), 40));
}

TEST(OcclusionMask, AgreesWithEmbreeUnderTheSun) {
  Scene scene = *scenes::load("boxes");
  Light sun;
  sun.kind = LightKind::directional;
  sun.direction = glm::normalize(glm::dvec3(0.6, -0.7, -0.3));
  sun.extent.kind = ExtentKind::disc;
  sun.extent.radius = 2.0;
  scene.lights = {sun};
  expect_agreement(compare(std::make_shared<const Scene>(scene), 64));
}

TEST(OcclusionMask, AgreesWithEmbreeAroundASphereOfLightBetweenTheBoxes) {
  Scene scene = *scenes::load("boxes");
  Light lamp;
  lamp.kind = LightKind::point;
  lamp.position = {0.3, 0.9, 0.2};
  lamp.extent.kind = ExtentKind::sphere;
  lamp.extent.radius = 0.2;
  scene.lights = {lamp};
  expect_agreement(compare(std::make_shared<const Scene>(scene), 64));
}

TEST(OcclusionMask, IsTheSameWhenTheHierarchyIsWalkedInParts) {
  const auto scene = scenes::load("boxes");
  Tracer tracer(scene);
  const Embree embree(tracer.scene());
  const CameraMatrices camera =
      camera_matrices(scene->cameras.front(), tracer.scene().origin(), 1.0, 1.0);
  const auto receivers = embree.receivers(camera, 64);
  const Light& light = scene->lights.front();
  const auto points = light_points(world_light(light, tracer.scene().origin()), 64, 1, 3, false);
  const auto whole = tracer.masks(light, receivers, 64, points);
  EXPECT_EQ(tracer.masks(light, receivers, 64, points, 137), whole);
  const auto alone = std::span<const glm::vec4>(points).first(32);
  EXPECT_EQ(tracer.masks(light, receivers, 64, alone, 137).front(), whole.front());
}

TEST(OcclusionMask, HidesEveryPointThatABatchDoesNotHave) {
  const auto scene = scenes::load("boxes");
  Tracer tracer(scene);
  const std::vector<Receiver> receivers(
      64, {tracer.scene().to_world({0.0, 30.0, 0.0}), {0.0f, 1.0f, 0.0f}, true});
  Light light = scene->lights.front();
  light.kind = LightKind::point;
  light.position = {0.0, 40.0, 0.0};
  const auto points = light_points(world_light(light, tracer.scene().origin()), 5, 1, 3, false);
  const auto masks = tracer.masks(light, receivers, 8, points);
  EXPECT_EQ(masks.front(), std::vector<std::uint32_t>(64, 0xffffffe0u));
}

}  // namespace embree_test
}  // namespace penumbra::tests
