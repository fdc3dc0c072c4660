// What a map keeps of a depth: even or in 1/z, in 32 or 16 bits, over a fitted or a fixed range.
// Judged by the closed form of rounding: of depths that fall anywhere within a step, those are too
// dark whose kept depth lies nearer to the light than the bias moves it away.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "plates.h"
#include "renderer/error.h"

namespace penumbra::tests {
namespace depth_coding_test {

/// A lit floor `distance` below a lamp, tilted so that a picture shows many steps of its depth.
Scene tilted_floor(double distance) {
  Scene scene = empty_scene(0.5, 0.1 * distance);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  const double slope = 0.2;
  scene.instances.back().world_from_object[0][1] = slope;
  scene.lights.push_back(lamp({0, distance, 0}, 5));
  return scene;
}

ParameterValues coding(const char* depth, const char* bits, double near, double far) {
  return {{"depth", std::string(depth)},
          {"depth_bits", std::string(bits)},
          {"near", near},
          {"far", far},
          {"map_size", std::int64_t{2048}}};
}

/// Share of the floor that shadows itself.
double acne(double distance, const ParameterValues& parameters) {
  const RenderResult result = draw(tilted_floor(distance), "shadow-map", parameters, 128);
  const auto& pixels = result.visibility.pixels;
  return static_cast<double>(std::count(pixels.begin(), pixels.end(), 0.0f)) /
         static_cast<double>(pixels.size());
}

constexpr double bias = 1e-3;  // m

double acne_under_bias(double distance, ParameterValues parameters) {
  parameters["bias_strategy"] = std::string("constant");
  parameters["slope_scale"] = 0.0;
  parameters["bias"] = bias;
  return acne(distance, parameters);
}

/// Rounding errors lie evenly within half a step to either side.
double expected_acne(double step) {
  return std::max(0.0, 0.5 - bias / step);
}

TEST(DepthCoding, sixteen_bits_in_1_z_fail_far_from_the_light_where_even_ones_do_not) {
  // van Sambeek 2007, 2.2.2. Steps at distance d are d^2 (1/near - 1/far) / 65535 in 1/z.
  const double near = 0.1, far = 12.0;
  for (const double distance : {3.0, 5.0, 10.0}) {
    SCOPED_TRACE(distance);
    const double step = distance * distance * (1.0 / near - 1.0 / far) / 65535.0;
    EXPECT_NEAR(acne_under_bias(distance, coding("hyperbolic", "16", near, far)),
                expected_acne(step), 0.03);
    EXPECT_EQ(acne_under_bias(distance, coding("linear", "16", near, far)), 0.0);
  }
}

TEST(DepthCoding, sixteen_bits_over_a_fixed_range_fail_where_a_fitted_one_serves) {
  // van Sambeek 2007, 2.2.3.
  const double near = 0.1, far = 1000.0;
  EXPECT_NEAR(acne_under_bias(5.0, coding("linear", "16", near, far)),
              expected_acne((far - near) / 65535.0), 0.03);
  EXPECT_EQ(acne_under_bias(5.0, coding("linear", "16", 0.0, 0.0)), 0.0);
}

TEST(DepthCoding, thirty_two_bits_serve_a_thousand_times_the_range) {
  EXPECT_EQ(acne_under_bias(5.0, coding("linear", "32", 0.1, 5000.0)), 0.0);
}

TEST(DepthCoding, every_strategy_knows_what_rounding_costs) {
  for (const char* strategy :
       {"constant", "slope", "normal-offset", "receiver-plane", "dual-depth"})
    for (const char* bits : {"16", "32"}) {
      SCOPED_TRACE(std::string(strategy) + " " + bits);
      ParameterValues parameters = coding("hyperbolic", bits, 0.01, 1000.0);
      parameters["bias_strategy"] = std::string(strategy);
      parameters["map_size"] = std::int64_t{512};
      EXPECT_EQ(acne(10.0, parameters), 0.0);
    }
}

TEST(DepthCoding, a_map_of_sixteen_bits_takes_half_the_memory) {
  const RenderResult result =
      draw(plate_over_ground(), "shadow-map", {{"depth_bits", std::string("16")}});
  ASSERT_EQ(result.cost.technique_memory.size(), 1u);
  EXPECT_EQ(result.cost.technique_memory[0].bytes, 524288u);
}

/// Light on the ground below a plate at 3 m, under a lamp at 4 m.
float lit_below_plate(double near, double far, const char* depth) {
  Scene scene = empty_scene(1.0, 0.5);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-0.3, -0.3}, {0.3, 0.3}, 3.0);
  scene.lights.push_back(lamp({0, 4, 0}, 20));
  return draw(scene, "shadow-map", {{"near", near}, {"far", far}, {"depth", std::string(depth)}}, 8)
      .visibility.at(4, 4, 0);
}

TEST(DepthCoding, casters_before_a_fixed_range_cast_and_those_behind_it_do_not) {
  for (const char* depth : {"linear", "hyperbolic"}) {
    SCOPED_TRACE(depth);
    EXPECT_EQ(lit_below_plate(0.0, 0.0, depth), 0.0f);
    EXPECT_EQ(lit_below_plate(2.0, 0.0, depth), 0.0f) << "the plate is clamped to near";
    EXPECT_EQ(lit_below_plate(0.0, 2.0, depth), 0.0f) << "the ground is clamped to far";
    EXPECT_EQ(lit_below_plate(0.1, 0.9, depth), 1.0f) << "both are";
    EXPECT_EQ(lit_below_plate(4.5, 9.0, depth), 1.0f) << "both are clamped to near";
  }
}

/// Light on the ground `distance` below a lamp, where a plate hangs `height` over it.
float lit_under(double height, double distance, const ParameterValues& parameters) {
  Scene scene = empty_scene(0.5 * height, 0.1);
  add_plate(scene, {-1, -1}, {1, 1}, 0.0);
  add_plate(scene, {-0.5, -0.5}, {0.5, 0.5}, height);
  scene.lights.push_back(lamp({0, distance, 0}, 0.1));
  return draw(scene, "shadow-map-polygon-offset", parameters, 4).visibility.at(2, 2, 0);
}

TEST(PolygonOffset, grants_steps_of_24_bits_wherever_the_plate_hangs) {
  // Sindholt 2005, 2.2.8: 4 units. A map of 1/z keeps (1/near - 1/z) / (1/near - 1/far), of which a
  // unit is 2^-24; level plates have no slope. Floats just below 1 are a unit apart, and each of
  // the two depths is rounded by one or so.
  const double near = 0.1, far = 2000.0;
  for (const double distance : {300.0, 500.0}) {
    const auto height_of = [&](double units) {
      return distance - 1.0 / (1.0 / distance + units * 0x1p-24 * (1.0 / near - 1.0 / far));
    };
    ParameterValues parameters{{"near", near}, {"far", far}};
    EXPECT_EQ(lit_under(height_of(1.2), distance, parameters), 1.0f) << distance;
    EXPECT_EQ(lit_under(height_of(6.8), distance, parameters), 0.0f) << distance;
    parameters["bias_units"] = 400.0;
    EXPECT_EQ(lit_under(height_of(396.0), distance, parameters), 1.0f) << distance;
    EXPECT_EQ(lit_under(height_of(404.0), distance, parameters), 0.0f) << distance;
  }
}

/// Dark share of a slope of 45 degrees `gap` below a parallel plate under a sun overhead, seen from
/// between them over one texel of 2 m. Lengths are in texels.
double dark_share_below_slope(double gap_texels) {
  const double gap = 2.0 * gap_texels;
  Scene scene = empty_scene(0.0, 2.0 * std::sqrt(2.0));
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-2, -2}, {2, 2}, -gap, false);
  for (Instance& plate : scene.instances) plate.world_from_object[0][1] = 1.0;
  scene.cameras[0].target = {0.0, -gap, 0.0};
  scene.cameras[0].position = scene.cameras[0].target + 0.1 * glm::dvec3(-1.0, 1.0, 0.0);
  scene.lights.push_back(sun());
  // Of 4 texels a quarter on each side is left free: 2 for the 4 m of the plates.
  const RenderResult result =
      draw(scene, "shadow-map-polygon-offset", {{"map_size", std::int64_t{4}}}, 100);
  const auto& pixels = result.visibility.pixels;
  return static_cast<double>(std::count(pixels.begin(), pixels.end(), 0.0f)) /
         static_cast<double>(pixels.size());
}

TEST(PolygonOffset, grants_1_1_times_what_a_slope_spans_in_a_texel) {
  // The map holds the plate's depth at the texel's middle and 1.1 texels; the slope is deeper by
  // the gap and by anything within half a texel.
  for (const double gap : {0.5, 0.7, 0.9, 1.1, 1.4, 1.7})
    EXPECT_NEAR(dark_share_below_slope(gap), std::clamp(gap - 1.1 + 0.5, 0.0, 1.0), 0.02) << gap;
}

TEST(DepthCoding, a_range_that_ends_before_it_begins_is_refused) {
  try {
    lit_below_plate(3.0, 2.0, "linear");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "bad_value");
    EXPECT_EQ(error.field, "near");
    EXPECT_THAT(error.what(), testing::HasSubstr("near is 3 m and far 2 m"));
  }
}

/// Boxes of many sizes on a floor that is tilted, too.
Scene crowd() {
  Scene scene = tilted_floor(10.0);
  for (int i = 0; i < 12; ++i) {
    const double x = 0.14 * (i % 4) - 0.3, z = 0.2 * (i / 4) - 0.3, size = 0.02 + 0.007 * i;
    add_box(scene, {x, 0.1, z}, {x + size, 0.1 + 3.0 * size, z + 0.5 * size});
  }
  return scene;
}

// Where the rasteriser comes to the depths that are kept, maps are drawn without a fragment stage.
// The least bias asks for one: depths are then computed for each fragment.
TEST(DepthCoding, interpolated_depths_cast_the_shadows_of_computed_ones) {
  Scene under_lamp = crowd(), under_sun = crowd();
  under_sun.lights = {sun()};
  under_sun.lights[0].direction = glm::normalize(glm::vec3(0.3f, -1.0f, 0.2f));
  struct Case {
    const Scene& scene;
    const char *depth, *bits, *layout;
  };
  for (const Case& c :
       {Case{under_lamp, "hyperbolic", "32", "single"},
        Case{under_lamp, "hyperbolic", "16", "single"}, Case{under_sun, "linear", "32", "single"},
        Case{under_sun, "linear", "16", "single"},
        Case{under_sun, "hyperbolic", "32", "cascaded"}}) {
    SCOPED_TRACE(std::string(c.depth) + c.bits + c.layout);
    ParameterValues parameters = coding(c.depth, c.bits, 0.0, 0.0);
    parameters["layout"] = std::string(c.layout);
    const auto seen = [&](double least_bias) {
      parameters["bias"] = least_bias;
      return draw(c.scene, "shadow-map", parameters, 256).visibility.pixels;
    };
    const std::vector<float> interpolated = seen(0.0), computed = seen(1e-12);
    std::size_t differ = 0, shadowed = 0;
    for (std::size_t i = 0; i < computed.size(); ++i) {
      differ += interpolated[i] != computed[i];
      shadowed += computed[i] == 0.0f;
    }
    EXPECT_GT(shadowed, 200u);
    EXPECT_LE(differ, computed.size() / 5000);
  }
}

}  // namespace depth_coding_test
}  // namespace penumbra::tests
