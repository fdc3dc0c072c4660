#include "renderer/frame/lit_part.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>
#include <random>

#include "renderer/render.h"
#include "renderer/scene/transforms.h"
#include "scenes/library.h"
#include "techniques/registry.h"
#include "tests/conformance/scenes.h"

namespace penumbra {
namespace {

CameraMatrices matrices(const Camera& camera) {
  return camera_matrices(camera, glm::dvec3(0.0), 1.0, 50.0);
}

// Seen from straight above, 2 m wide: a pixel of 100 is 2 cm, and one more is left on every side.
TEST(LitPart, is_the_box_as_an_orthographic_camera_sees_it) {
  const CameraMatrices camera = matrices(test::open_ground().cameras[0]);
  const std::vector<Bounds> box{{{-0.5, 0.0, -0.3}, {0.5, 0.0, 0.3}}};
  const VkRect2D part = seen_part(box, glm::dvec3(0.0), camera.clip_from_world, 100, 100);
  EXPECT_EQ(part.extent.width, 52u);
  EXPECT_EQ(part.extent.height, 32u);
  EXPECT_EQ(part.offset.x, 24);
  EXPECT_EQ(part.offset.y, 34);
  EXPECT_EQ(seen_part({}, glm::dvec3(0.0), camera.clip_from_world, 100, 100).extent.width, 0u);
}

TEST(LitPart, and_what_lies_outside_cover_every_sample_once) {
  const std::uint32_t width = 7, height = 5;
  const auto add = [](std::vector<int>& samples, const VkRect2D& part) {
    for (std::uint32_t y = 0; y < part.extent.height; ++y)
      for (std::uint32_t x = 0; x < part.extent.width; ++x)
        ++samples.at((static_cast<std::uint32_t>(part.offset.y) + y) * 7 +
                     static_cast<std::uint32_t>(part.offset.x) + x);
  };
  for (const VkRect2D& part :
       {VkRect2D{{0, 0}, {7, 5}}, VkRect2D{{0, 0}, {0, 0}}, VkRect2D{{2, 1}, {3, 2}},
        VkRect2D{{0, 2}, {7, 3}}, VkRect2D{{5, 0}, {2, 5}}, VkRect2D{{7, 5}, {0, 0}}}) {
    std::vector<int> samples(35);
    add(samples, part);
    for (const VkRect2D& rest : outside(part, width, height)) add(samples, rest);
    EXPECT_EQ(samples, std::vector<int>(35, 1)) << part.offset.x << ", " << part.offset.y;
  }
}

/// Boxes that glow a little under a sky of two colours, half of them outside a lamp's cone.
Scene glowing_boxes() {
  Scene scene = *scenes::load("boxes");
  scene.background_high = {0.2f, 0.3f, 0.9f};
  scene.background_low = {0.9f, 0.8f, 0.7f};
  scene.ambient = {0.03f, 0.05f, 0.07f};
  scene.materials.front().emissive = {0.1f, 0.02f, 0.0f};
  scene.lights.front().kind = LightKind::spot;
  scene.lights.front().outer_angle = 6.0;
  scene.lights.front().inner_angle = 5.0;
  scene.cameras.front().target.y += 3.0;
  return scene;
}

// One light writes finished pixels, and what it does not reach is drawn by others; several lights
// are summed first. A second light that is as good as dark tells whether these come to the same.
TEST(LitPart, is_finished_as_if_there_were_more_lights) {
  Renderer renderer({.device = "", .validation = true});
  const auto draw = [&](const Scene& scene, const char* technique) {
    RenderRequest request;
    request.scene = std::make_shared<const Scene>(scene);
    request.technique = techniques::resolve(technique).technique;
    request.parameters = techniques::resolve(technique).parameters;
    request.width = 160;
    request.height = 120;
    request.light_samples = 16;
    request.linear = true;
    return renderer.render(request);
  };
  const auto unlike = [](const ImageF& a, const ImageF& b) {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < a.pixel_count(); ++i)
      pixels += !std::equal(&a.pixels[4 * i], &a.pixels[4 * i] + 3, &b.pixels[4 * i]);
    return pixels;
  };
  Scene plain = glowing_boxes(), dark = glowing_boxes();
  plain.materials.front().emissive = {};
  dark.lights.front().intensity = 1e-30f;
  const ImageF glowing = draw(glowing_boxes(), "none").linear;
  const std::size_t glow = unlike(glowing, draw(plain, "none").linear);
  const std::size_t lit = unlike(glowing, draw(dark, "none").linear);
  EXPECT_GT(glow, 100u);
  EXPECT_GT(lit, 500u);
  EXPECT_LT(lit, glowing.pixel_count() / 2);
  for (const char* technique : {"none", "shadow-map", "shadow-volumes", "ray-traced", "reference"})
    for (const Scene& one : {glowing_boxes(), plain}) {
      SCOPED_TRACE(technique);
      Scene two = one;
      two.lights.push_back(dark.lights.front());
      two.lights.back().name = "dark";
      const RenderResult finished = draw(one, technique), summed = draw(two, technique);
      EXPECT_EQ(finished.picture.pixels, summed.picture.pixels);
      EXPECT_EQ(finished.linear.pixels, summed.linear.pixels);
    }
}

TEST(LitPart, holds_every_point_of_the_boxes_that_the_camera_sees) {
  std::mt19937 generator(7);
  const auto random = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(generator()) / 4294967295.0);
  };
  const glm::dvec3 origin(3.0, -2.0, 5.0);
  std::size_t seen = 0;
  for (int round = 0; round < 200; ++round) {
    Camera camera;
    camera.position = {random(-2, 2), random(-2, 2), random(-2, 2)};
    camera.target = camera.position + glm::dvec3(random(-1, 1), random(-0.5, 0.5), 1.0);
    camera.vertical_fov = random(20.0, 100.0);
    const glm::dmat4 clip_from_world = matrices(camera).clip_from_world;
    const glm::dvec3 low(random(-4, 3), random(-4, 3), random(-4, 3));
    const Bounds box{low, low + glm::dvec3(random(0, 4), random(0, 4), random(0, 4))};
    const std::vector<Bounds> placed{{box.low + origin, box.high + origin}};
    const VkRect2D part = seen_part(placed, origin, clip_from_world, 640, 360);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 point =
          box.low + box.size() * glm::dvec3(random(0, 1), random(0, 1), random(0, 1));
      const glm::dvec4 clip = clip_from_world * glm::dvec4(point, 1.0);
      if (clip.w <= camera.near_plane || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w)
        continue;
      ++seen;
      const double x = (0.5 + 0.5 * clip.x / clip.w) * 640 - part.offset.x;
      const double y = (0.5 + 0.5 * clip.y / clip.w) * 360 - part.offset.y;
      ASSERT_TRUE(x >= 0.0 && x <= part.extent.width && y >= 0.0 && y <= part.extent.height)
          << round << ": " << x << ", " << y;
    }
  }
  EXPECT_GT(seen, 3000u);
}

// The light hangs 4 m above the middle: its cone of 8 degrees is a circle of 0.56 m on the ground.
TEST(LitPart, a_cone_is_shaded_whole_and_little_besides) {
  Scene scene = test::open_ground();
  scene.lights[0].position = {0, 4, 0};
  scene.lights[0].direction = {0, -1, 0};
  scene.lights[0].inner_angle = 6.0;
  scene.lights[0].outer_angle = 8.0;
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(scene);
  request.technique = techniques::resolve("none").technique;
  request.width = request.height = 200;
  request.visibility = true;
  const RenderResult result = Renderer({.device = "", .validation = true}).render(request);
  const double judged =
      std::accumulate(result.judged.pixels.begin(), result.judged.pixels.end(), 0.0);
  const double radius = 100.0 * 4.0 * std::tan(8.0 * std::numbers::pi / 180.0);  // pixels
  EXPECT_NEAR(judged, std::numbers::pi * radius * radius, 0.01 * judged);
  for (const PassCost& pass : result.cost.passes) {
    if (pass.name != "shade") continue;
    // A square around the cone, which is wider below the ground; some drivers count whole blocks.
    EXPECT_LT(pass.fragment_invocations, 200u * 200u / 2);
    EXPECT_GE(static_cast<double>(pass.fragment_invocations), judged);
  }
}

}  // namespace
}  // namespace penumbra
