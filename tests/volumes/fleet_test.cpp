// Occluder textures of one to two hundred aircraft (Coleman 2006, 6.2).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>

#include "scenes/built_in/built_in.h"
#include "tests/kept_pictures/kept_pictures.h"
#include "tests/volumes/drawing.h"

namespace penumbra {
namespace {

using test::draw;

class Fleets : public testing::TestWithParam<int> {};

TEST_P(Fleets, have_planes_for_every_aircraft_and_shadows_as_good_as_one_has) {
  const Scene scene = scenes::make_fleet(GetParam());
  const RenderResult rays = draw(scene, "ray-traced", {{"rays", std::int64_t{1}}});
  const auto missing = [&](const RenderResult& result) {
    return tests::visibility_error(result.visibility, rays.visibility, rays.judged).missing_shadow;
  };
  const RenderResult own = draw(scene, "occluder-textures");
  EXPECT_LT(missing(own), 0.35 * missing(draw(scene, "none")));
  const std::string count = std::to_string(16 * GetParam() + 1);
  EXPECT_THAT(own.notes, testing::Contains(testing::StartsWith(count + " generated planes")));
  // Aircraft share their textures: 16 of the jet and one of the ground, whatever their number.
  std::uint64_t bytes = 0;
  for (const ResourceCost& resource : own.cost.technique_memory)
    if (resource.name == "occluder textures") bytes = resource.bytes;
  EXPECT_GE(bytes, 17u * 256 * 256);
  EXPECT_LT(bytes, 2u * 17u * 256 * 256);
}

std::uint64_t vertices(const RenderResult& result) {
  std::uint64_t sum = 0;
  for (const PassCost& pass : result.cost.passes) sum += pass.vertices;
  return sum;
}

TEST_P(Fleets, are_drawn_once_with_occluder_textures_and_twice_with_a_shadow_map) {
  const Scene scene = scenes::make_fleet(GetParam());
  const auto once = static_cast<double>(vertices(draw(scene, "none")));
  const double ours = vertices(draw(scene, "occluder-textures")) / once;
  const double map = vertices(draw(scene, "shadow-map")) / once;
  std::cout << "vertices over those of no shadows, " << GetParam()
            << " aircraft: occluder textures " << ours << ", shadow map " << map << '\n';
  EXPECT_EQ(ours, 1.0);
  EXPECT_GT(map, 1.9);
}

INSTANTIATE_TEST_SUITE_P(Of, Fleets, testing::Values(1, 20, 200));

}  // namespace
}  // namespace penumbra
