// Summed-area variance shadow maps against counted comparisons, which their bound equals here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "plates.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace {

/// A plate that leaves three sides of the ground free, under a sun: the map holds two depths, and
/// the shadow lies towards the map's far corner, where sums are greatest.
Scene far_corner() {
  Scene scene = empty_scene(1.5, 4.0);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-0.5, -0.5}, {1.8, 1.8}, 1.0);
  // Depths that no table holds by chance: 0.28 for the plate, 0.594 for the ground.
  add_plate(scene, {-2, -2}, {-1.9, -1.9}, 1.9);
  add_plate(scene, {-2, 1.9}, {-1.9, 2}, -1.3);
  scene.lights.push_back(sun());
  return scene;
}

/// Root mean square difference of a table's bound to comparisons counted over the same texels.
double table_error(const std::string& preset, std::int64_t map_size, std::int64_t kernel) {
  static const auto scene = std::make_shared<const Scene>(far_corner());
  const RenderResult bound = draw(scene, preset,
                                  {{"map_size", map_size},
                                   {"kernel", kernel},
                                   {"adaptive", false},
                                   {"slope_scale", 0.0},
                                   {"bias", 0.001},
                                   {"bleeding_reduction", 0.0}},
                                  150);
  const RenderResult counted =
      draw(scene, "pcf", {{"map_size", map_size}, {"kernel", kernel}}, 150);
  return tests::visibility_error(bound.visibility, counted.visibility, counted.judged).rms;
}

TEST(SummedArea, precise_tables_equal_counted_comparisons_for_any_kernel) {
  // Wide kernels reach specks at other depths, of which the bound knows nothing.
  for (const std::int64_t kernel : {1, 2, 12})
    EXPECT_LT(table_error("savsm-int32", 256, kernel), 0.02) << kernel;
  EXPECT_LT(table_error("savsm-fp64", 256, 5), 0.02);
}

TEST(SummedArea, floats_break_down_as_the_map_grows_and_whole_numbers_do_not) {
  // Adorjan 2013, 4.2.1: distributed floats suffice at 512, whole numbers at 1024 as well.
  const double exact = table_error("savsm-fp64", 512, 5);
  EXPECT_NEAR(table_error("savsm-distributed", 512, 5), exact, 1e-3);
  EXPECT_NEAR(table_error("savsm-int32", 512, 5), exact, 1e-3);
  const double exact_in_large = table_error("savsm-fp64", 1024, 5);
  EXPECT_GT(table_error("savsm-fp32", 1024, 5), 10.0 * exact_in_large);
  EXPECT_NEAR(table_error("savsm-int32", 1024, 5), exact_in_large, 1e-3);
  EXPECT_GT(table_error("savsm-fp32", 2048, 5), 0.03);
  EXPECT_GT(table_error("savsm-distributed", 2048, 5), 0.03);
  EXPECT_LT(table_error("savsm-int32", 2048, 5), 1e-3);
}

/// Ground at even depth `depth` of a map that begins and ends at small plates beside it, under a
/// sun.
Scene ground_at(double depth) {
  // The range is a ten-thousandth wider than what it holds. The camera sees all of it: what shadows
  // nothing and is not seen would be left out.
  const double ground = 2.0 - 2.0 * 1.0001 * depth;
  Scene scene = empty_scene(3.0, 4.2);
  add_plate(scene, {-1.8, -1.8}, {1.8, 1.8}, ground);
  add_plate(scene, {-2, -2}, {-1.9, -1.9}, 2.0);
  add_plate(scene, {1.9, 1.9}, {2, 2}, 0.0);
  scene.lights.push_back(sun());
  return scene;
}

/// Chebyshev's bound for a receiver at the depth that the map holds everywhere, whose two moments
/// were rounded to steps of 1 / units.
double bound_of_rounded_moments(double depth, double units, double deviation) {
  const double first = std::floor(units * depth + 0.5) / units;
  const double second = std::floor(units * depth * depth + 0.5) / units;
  const double variance = std::max(second - first * first, deviation * deviation);
  const double behind = depth - first;
  return behind <= 0.0 ? 1.0 : variance / (variance + behind * behind);
}

TEST(SummedArea, whole_numbers_that_never_wrap_keep_the_bits_that_the_maps_texels_leave) {
  // Adorjan 2013, 2.2.1: log2(width * height) bits are lost to the sum over the whole map.
  constexpr double deviation = 3e-4;
  const auto drawn = [&](const char* preset, double depth, std::int64_t map_size) {
    const RenderResult result = draw(ground_at(depth), preset,
                                     {{"map_size", map_size},
                                      {"kernel", std::int64_t{1}},
                                      {"adaptive", false},
                                      {"slope_scale", 0.0},
                                      {"bleeding_reduction", 0.0},
                                      {"minimum_deviation", deviation}},
                                     4);
    return double{result.visibility.at(2, 2, 0)};
  };
  // Of 32 bits 10 are left at 2048x2048, and 14 at 512x512.
  const double coarse = std::floor(0x1p32 / 0x1p22 - 0.001), fine = 0x1p32 / 0x1p18 - 1.0;
  for (const double depth : {0.057, 0.0718, 0.1754, 0.1939, 0.2605, 0.3678, 0.5, 0.7}) {
    const double expected = bound_of_rounded_moments(depth, coarse, deviation);
    EXPECT_EQ(expected < 0.6, depth < 0.4) << "depths chosen so that ten bits show at six of them";
    EXPECT_NEAR(drawn("savsm-int32-plain", depth, 2048), expected, 0.05) << depth;
    EXPECT_NEAR(drawn("savsm-int32-plain", depth, 512),
                bound_of_rounded_moments(depth, fine, deviation), 0.02)
        << depth;
    // Sums that wrap lose no bits to the rest of the map.
    EXPECT_NEAR(drawn("savsm-int32", depth, 2048), 1.0, 0.02) << depth;
  }
  // Nearly clean at 1024, where floats break down (4.2.1).
  EXPECT_LT(table_error("savsm-int32-plain", 1024, 5), 0.3 * table_error("savsm-fp32", 1024, 5));
}

TEST(SummedArea, an_entry_takes_8_bytes_or_16) {
  for (const auto& [preset, bytes] : {std::pair{"savsm-fp32", 8u},
                                      {"savsm-int32", 8u},
                                      {"savsm-int32-plain", 8u},
                                      {"savsm-distributed", 16u},
                                      {"savsm-fp64", 16u}}) {
    std::uint64_t found = 0;
    for (const ResourceCost& resource :
         draw(far_corner(), preset, {{"map_size", std::int64_t{64}}}, 8).cost.technique_memory)
      if (resource.name == "summed-area table") found = resource.bytes;
    EXPECT_EQ(found, 64u * 64u * bytes) << preset;
  }
}

TEST(SummedArea, the_kernel_does_not_change_the_work) {
  // Invocations are what can be counted; bench times it.
  const auto invocations = [](std::int64_t kernel) {
    std::uint64_t sum = 0;
    for (const PassCost& pass : draw(far_corner(), "savsm", {{"kernel", kernel}}).cost.passes)
      sum += pass.compute_invocations;
    return sum;
  };
  EXPECT_GT(invocations(3), 2u * 512u * 32u - 1u);
  EXPECT_EQ(invocations(3), invocations(129));
}

}  // namespace
}  // namespace penumbra::tests
