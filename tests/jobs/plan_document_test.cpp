#include "server/jobs/plan_document.h"

#include <gtest/gtest.h>

namespace penumbra::server {
namespace {

nlohmann::json plan_of(const std::string& scene, const std::string& technique, int map_size) {
  return plan_document(read_request(
      {{"scene", scene}, {"technique", technique}, {"parameters", {{"map_size", map_size}}}}, {}));
}

TEST(PlanDocument, tells_the_bytes_of_a_techniques_maps_light_by_light) {
  // Depths of 32 bits: four bytes a texel.
  const auto one = plan_of("boxes", "shadow-map", 256);
  EXPECT_EQ(one.at("bytes").at("technique"), 256 * 256 * 4);
  ASSERT_EQ(one.at("lights").size(), 1u);
  ASSERT_EQ(one.at("lights")[0].at("memory").size(), 1u);
  EXPECT_EQ(one.at("lights")[0].at("memory")[0].at("bytes"), 256 * 256 * 4);
  const auto three = plan_of("disco-box", "shadow-map", 512);
  EXPECT_EQ(three.at("bytes").at("technique"), 3 * 512 * 512 * 4);
}

}  // namespace
}  // namespace penumbra::server
