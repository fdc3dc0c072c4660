#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "scenes/library.h"
#include "tracer.h"

namespace penumbra::tests {
namespace embree_test {

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

/// Compares all rays from what the first camera sees, in a picture of so many pixels, to `count`
/// points of every light.
Verdict compare(const std::shared_ptr<const Scene>& scene, std::uint32_t count,
                std::uint32_t size = 128) {
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

Scene boxes_under_a_disc() {
  Scene scene = *scenes::load("boxes");
  scene.lights.resize(1);
  scene.lights.front().extent.kind = ExtentKind::disc;
  scene.lights.front().extent.radius = 0.3;
  return scene;
}

/// The scene with so many specks of dust before its first light, of a size that leaves most of the
/// light: a walk towards a batch of points meets a share of them and finds no end before the last.
std::shared_ptr<const Scene> with_dust(Scene scene, std::uint32_t count,
                                       std::uint32_t material = 0) {
  const Light& light = scene.lights.front();
  const glm::dvec3 towards = glm::normalize(light.direction);
  const glm::dvec3 across = glm::normalize(glm::cross(towards, glm::dvec3(0.3, 0.2, 0.9)));
  const glm::dvec3 beside = glm::cross(towards, across);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Mesh mesh;
  mesh.name = "dust";
  const double speck = 1.5 * light.extent.radius / std::sqrt(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 middle = light.position + (0.15 + 0.05 * unit(random)) * towards +
                              light.extent.radius * (unit(random) * across + unit(random) * beside);
    for (int corner = 0; corner < 3; ++corner) {
      mesh.positions.emplace_back(middle +
                                  speck * glm::dvec3(unit(random), unit(random), unit(random)));
      mesh.normals.emplace_back(glm::vec3(towards));
      mesh.uvs.emplace_back(unit(random), unit(random));
      mesh.indices.push_back(3 * i + static_cast<std::uint32_t>(corner));
    }
  }
  mesh.primitives = {{0, 3 * count, material}};
  Instance instance;
  instance.name = "dust";
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(mesh);
  scene.instances.push_back(instance);
  return std::make_shared<const Scene>(scene);
}

TEST(OcclusionMask, AgreesWithEmbreeWhereWalksAreLongerThanDriversLetLoopsBe) {
  const Scene scene = boxes_under_a_disc();
  const Verdict verdict = compare(with_dust(scene, 40000), 64, 48);
  // Of the 4000 rays that dust alone hides, one in a hundred passes an edge of its specks of 2 mm
  // by less than floats tell; a sixteenth as many specks, four times as large, leave a quarter of
  // that.
  EXPECT_GT(verdict.hidden, compare(std::make_shared<const Scene>(scene), 64, 48).hidden + 2000u);
  EXPECT_LE(verdict.different, 100u);
  EXPECT_LE(compare(with_dust(scene, 2500), 64, 48).different, 25u);
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

TEST(OcclusionMask, IsTheSameWhenWalksAmongHolesAreResumed) {
  // Every test of such a triangle is a loop of its own.
  Scene scene = boxes_under_a_disc();
  Texture texture{"checks", 2, 2, {}};
  for (int texel = 0; texel < 4; ++texel)
    texture.rgba.insert(texture.rgba.end(),
                        {255, 255, 255, std::uint8_t(texel % 3 == 0 ? 255 : 0)});
  Material material;
  material.name = "checks";
  material.texture = static_cast<int>(scene.textures.size());
  material.alpha_mode = AlphaMode::mask;
  scene.textures.push_back(texture);
  scene.materials.push_back(material);
  const auto dusty = with_dust(scene, 3000, static_cast<std::uint32_t>(scene.materials.size()) - 1);
  Tracer tracer(dusty);
  const Embree embree(tracer.scene());
  const CameraMatrices camera =
      camera_matrices(dusty->cameras.front(), tracer.scene().origin(), 1.0, 1.0);
  const auto receivers = embree.receivers(camera, 32);
  const Light& light = dusty->lights.front();
  const auto points = light_points(world_light(light, tracer.scene().origin()), 64, 1, 3, false);
  const auto usual = tracer.masks(light, receivers, 32, points);
  EXPECT_EQ(tracer.masks(light, receivers, 32, points, 300), usual);
  EXPECT_EQ(tracer.masks(light, receivers, 32, points, 40), usual);
  EXPECT_EQ(tracer.unfinished(), 0u);
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
