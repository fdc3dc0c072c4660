#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "figures/charts.h"
#include "tests/figures/xml.h"

namespace penumbra::figures {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

HeatMap two_by_two() {
  HeatMap map;
  map.frame.title = "how far";
  map.columns = {"first", "second"};
  map.rows = {{"one", {{0.0, "0.1"}, {1.0, "holds"}}},
              {"two <b>", {{std::nullopt, ""}, {0.5, "7"}}}};
  map.low = "breaks";
  map.high = "holds on";
  return map;
}

TEST(HeatMap, is_well_formed_and_says_every_name_and_cell) {
  const Xml xml = parse_xml(draw(two_by_two()));
  EXPECT_EQ(xml.error, "");
  for (const char* text : {"first", "second", "one", "0.1", "holds", "7", "breaks", "holds on"})
    EXPECT_THAT(xml.texts(), Contains(text));
}

TEST(HeatMap, shades_from_dark_to_light_and_leaves_blanks_white) {
  const Xml xml = parse_xml(draw(two_by_two()));
  std::vector<std::string> fills;
  for (const Element& box : xml.named("rect")) fills.push_back(box.attributes.at("fill"));
  // The page, three cells, eleven steps of the scale.
  ASSERT_EQ(fills.size(), 15u);
  EXPECT_EQ(fills[1], fills[4]);      // darkest
  EXPECT_EQ(fills[2], fills.back());  // lightest
  EXPECT_NE(fills[1], fills[2]);
}

TEST(HeatMap, without_rows_says_so) {
  HeatMap map;
  map.frame.empty = "nothing was measured";
  EXPECT_THAT(draw(map), HasSubstr("nothing was measured"));
}

}  // namespace
}  // namespace penumbra::figures
