// The hybrid of map and volumes against exact rays, and against its two parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/kept_pictures/kept_pictures.h"
#include "tests/volumes/drawing.h"

namespace penumbra {
namespace {

using test::draw;

/// Share of the judged pixels on which two pictures differ.
double difference(const RenderResult& a, const RenderResult& b) {
  double judged = 0.0;
  double unlike = 0.0;
  for (std::size_t i = 0; i < a.judged.pixels.size(); ++i) {
    if (a.judged.pixels[i] < 1.0f) continue;
    ++judged;
    unlike += a.visibility.pixels[i] != b.visibility.pixels[i];
  }
  return unlike / judged;
}

class Hybrids : public testing::TestWithParam<const char*> {};

TEST_P(Hybrids, are_nearly_as_exact_as_volumes_and_far_more_than_their_map) {
  const Scene scene = *scenes::load(GetParam());
  const RenderResult rays = draw(scene, "ray-traced", {{"rays", std::int64_t{1}}});
  const double hybrid = difference(draw(scene, "hybrid"), rays);
  EXPECT_LT(hybrid, 0.002);
  EXPECT_LT(hybrid, difference(draw(scene, "shadow-map"), rays) / 5.0);
}

INSTANTIATE_TEST_SUITE_P(Of, Hybrids, testing::Values("boxes", "contact", "three-layers"));

/// A floating plate, and a pole of a thickness over the ground.
Scene pole(double thickness) {
  scenes::SceneBuilder b("pole", "A thin caster");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0, -3.0}, {3.0, 3.0}, look);
  b.place(scenes::box({-1.5, 0.8, -0.5 * thickness}, {1.5, 0.8 + thickness, 0.5 * thickness}), look,
          "pole", glm::rotate(glm::dmat4(1.0), 0.35, glm::dvec3(0.0, 1.0, 0.0)));
  b.spot("lamp", {0.4, 4.0, 1.0}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 45.0, LightExtent{});
  b.camera("main", {0.0, 3.5, 3.0}, {0.0, 0.0, 0.0}, 45.0);
  return b.scene;
}

TEST(Hybrid, loses_thin_casters_that_a_small_map_misses) {
  const Scene scene = pole(0.02);
  const RenderResult volumes = draw(scene, "shadow-volumes");
  Scene bare = scene;
  bare.instances.resize(1);
  const double shadow = difference(volumes, draw(bare, "shadow-volumes"));
  const auto lost = [&](std::int64_t map_size) {
    return difference(draw(scene, "hybrid", {{"map_size", map_size}}), volumes) / shadow;
  };
  // Texels of the map are 0.13 m wide on the ground at 64 and 0.008 m at 1024.
  EXPECT_GT(lost(64), 0.2);
  EXPECT_LT(lost(1024), 0.02);
}

TEST(Hybrid, removes_the_acne_of_a_map_without_bias) {
  const Scene scene = *scenes::load("contact");
  const RenderResult rays = draw(scene, "ray-traced", {{"rays", std::int64_t{1}}});
  const ParameterValues no_bias{{"bias_strategy", std::string("constant")}, {"slope_scale", 0.0}};
  const auto false_shadow = [&](const char* technique, const ParameterValues& parameters) {
    return tests::visibility_error(draw(scene, technique, parameters).visibility, rays.visibility,
                                   rays.judged)
        .false_shadow;
  };
  const double map = false_shadow("shadow-map", no_bias);
  EXPECT_GT(map, 0.1) << "acne is there";
  EXPECT_LT(false_shadow("hybrid", no_bias), map / 5.0);
  EXPECT_LT(false_shadow("shadow-volumes", {}), 0.001);
}

/// Number before " %" after some words of the first note that has them.
double percentage_after(const RenderResult& result, const std::string& words) {
  for (const std::string& note : result.notes)
    if (const auto at = note.find(words); at != std::string::npos)
      return std::stod(note.substr(at + words.size()));
  ADD_FAILURE() << "no note says " << words;
  return 100.0;
}

TEST(Hybrid, says_that_volumes_decide_few_samples_and_draw_few_fragments) {
  const RenderResult result = draw(*scenes::load("boxes"), "hybrid");
  const double samples = percentage_after(result, "volumes decide ");
  EXPECT_GT(samples, 0.1);
  EXPECT_LT(samples, 12.0);
  const double fragments = percentage_after(result, "face it and draw ");
  EXPECT_GT(fragments, 0.1);
  EXPECT_LT(fragments, 20.0);
}

TEST(Hybrid, lets_volumes_decide_nothing_where_nothing_casts_a_shadow) {
  Scene scene = pole(0.02);
  scene.instances.resize(1);
  const RenderResult result = draw(scene, "hybrid");
  EXPECT_EQ(percentage_after(result, "volumes decide "), 0.0);
}

}  // namespace
}  // namespace penumbra
