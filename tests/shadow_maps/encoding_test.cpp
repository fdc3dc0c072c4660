// Linear light and its encoding, and work that does not hang on the picture's size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "scenes.h"

namespace penumbra::tests {
namespace {

Image8 picture_with(const std::string& gamma) {
  return draw(scenes::load("boxes"), "shadow-map", {{"gamma", gamma}}, 64).picture;
}

double mean_of(const Image8& picture) {
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    if (i % 4 != 3) sum += picture.pixels[i];
  return sum / (3.0 * static_cast<double>(picture.pixel_count()));
}

/// IEC 61966-2-1, of an 8-bit value.
double srgb(double linear) {
  linear = std::clamp(linear / 255.0, 0.0, 1.0);
  return 255.0 *
         (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055);
}

TEST(Encoding, a_picture_without_it_is_too_dark_and_colours_taken_for_linear_are_too_bright) {
  // Adorjan 2013, A.5.
  const double correct = mean_of(picture_with("correct"));
  EXPECT_LT(mean_of(picture_with("input_only")), 0.9 * correct);
  EXPECT_LT(mean_of(picture_with("input_twice")), 0.9 * correct);
  EXPECT_GT(mean_of(picture_with("output_only")), 1.1 * correct);
  const double off = mean_of(picture_with("off"));
  EXPECT_GT(off, mean_of(picture_with("input_only")));
  EXPECT_LT(off, mean_of(picture_with("output_only")));
}

/// Ground whose left half has a texture of one colour and whose right half has none, both white by
/// their material, under ambient light alone.
Scene half_textured(std::uint8_t stored) {
  Scene scene = empty_scene(1.0, 2.0);
  add_plate(scene, {-2, -2}, {0, 2}, 0.0);
  add_plate(scene, {0, -2}, {2, 2}, 0.0);
  scene.materials[0].base_color = glm::vec3(1.0f);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].base_color = glm::vec3(0.25f);
  scene.materials[0].texture = 0;
  scene.textures.push_back({"grey", 1, 1, {stored, stored, stored, 255}});
  scene.meshes[1].primitives[0].material = 1;
  scene.lights.push_back(sun());
  scene.lights[0].intensity = 0.0f;
  scene.ambient = glm::vec3(1.0f);
  return scene;
}

TEST(Encoding, textures_that_are_not_decoded_are_encoded_twice_and_too_bright_where_they_are) {
  // Adorjan 2013, fig. A.7. What is stored as 100 is taken for 100/255 of linear light and encoded
  // once more; a colour without texture stays as it is.
  for (const int stored : {40, 100, 180}) {
    const Scene scene = half_textured(static_cast<std::uint8_t>(stored));
    const auto picture = [&](const char* gamma) {
      return draw(scene, "none", {{"gamma", std::string(gamma)}}, 16).picture;
    };
    const Image8 right = picture("correct"), twice = picture("textures_encoded_twice");
    EXPECT_NEAR(right.at(3, 8, 0), stored, 1) << stored;
    EXPECT_NEAR(twice.at(3, 8, 0), srgb(stored), 1.0) << stored;
    EXPECT_EQ(twice.at(12, 8, 0), right.at(12, 8, 0)) << stored;
  }
}

TEST(Encoding, follows_the_standards_curve) {
  const std::pair<const char*, const char*> pairs[] = {{"input_only", "correct"},
                                                       {"off", "output_only"}};
  for (const auto& [linear, encoded] : pairs) {
    const Image8 before = picture_with(linear);
    const Image8 after = picture_with(encoded);
    for (std::size_t i = 0; i < before.pixels.size(); ++i) {
      if (i % 4 == 3) continue;
      const double value = before.pixels[i];  // rounded to half a step
      ASSERT_GE(after.pixels[i], std::floor(srgb(value - 0.5)) - 1.0) << linear << " at " << i;
      ASSERT_LE(after.pixels[i], std::ceil(srgb(value + 0.5)) + 1.0) << linear << " at " << i;
    }
  }
}

TEST(FilteringCost, of_a_map_does_not_hang_on_the_pictures_size) {
  // van Sambeek 2007, 4.2.1: variance shadow maps pay for filtering at any size of the picture.
  const auto invocations = [](std::uint32_t size) {
    std::uint64_t sum = 0;
    for (const PassCost& pass : draw(scenes::load("boxes"), "vsm", {}, size).cost.passes)
      if (pass.name.find("blur") != std::string::npos) sum += pass.compute_invocations;
    return sum;
  };
  constexpr std::uint64_t texels = 512 * 512, run = 8;
  EXPECT_GE(invocations(25), 2 * texels / run);
  EXPECT_EQ(invocations(25), invocations(100));
}

}  // namespace
}  // namespace penumbra::tests
