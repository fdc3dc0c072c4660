// Summed-area variance shadow maps against counted comparisons, which their bound equals here.
#include <gtest/gtest.h>

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

TEST(SummedArea, an_entry_takes_8_bytes_or_16) {
  for (const auto& [preset, bytes] : {std::pair{"savsm-fp32", 8u},
                                      {"savsm-int32", 8u},
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
