// Pages say what was measured: docs/measurements/safe-ranges.md and the pages of the techniques
// quote docs/measurements/stability.csv. With PENUMBRA_WRITE_PAGES set they are written.
#include "experiments/stability/safe_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "renderer/error.h"
#include "techniques/registry.h"

namespace penumbra::experiments::stability {
namespace {

namespace fs = std::filesystem;

const fs::path root = PENUMBRA_SOURCE_DIR;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<SafeRange> measured() {
  return read_safe_ranges(read(root / "docs/measurements/stability.csv"));
}

/// What a page says of safe ranges: from those words to the next empty line.
const std::regex quoted(R"(\*\*Safe ranges\*\*(?:.|\n)*?\n(?=\n|$))");

/// A page with the paragraph as it ought to be, at its place or, where it has none, at the end.
std::string with_quote(const std::string& page, const std::string& quote) {
  std::smatch found;
  if (!std::regex_search(page, found, quoted)) return page + "\n" + quote;
  return std::string(found.prefix()) + quote + std::string(found.suffix());
}

void expect_page(const fs::path& path, const std::string& wanted) {
  if (std::getenv("PENUMBRA_WRITE_PAGES") != nullptr) std::ofstream(path) << wanted;
  EXPECT_EQ(read(path), wanted) << "PENUMBRA_WRITE_PAGES=1 with this test writes " << path;
}

TEST(SafeRanges, PagesQuoteWhatWasMeasured) {
  const auto ranges = measured();
  expect_page(root / "docs/measurements/safe-ranges.md", safe_ranges_page(ranges));
  for (const auto& technique : techniques::all()) {
    // One that came after the measurement has nothing to quote.
    if (std::none_of(ranges.begin(), ranges.end(),
                     [&](const auto& range) { return range.technique == technique.id; }))
      continue;
    const auto path = root / "techniques" / technique.id / "README.md";
    expect_page(path, with_quote(read(path), safe_ranges_quote(technique.id, ranges)));
  }
}

TEST(SafeRanges, AreReadFromResultsAndSaidWithDirectionAndUnit) {
  const auto ranges = read_safe_ranges(
      "technique,axis,gentle_rms,holds,ends,verdict,cause,guard,why\n"
      "pcss,ground,0.01,316228,421697,defect,\"light, on 2%\",none,x\n"
      "pcss,map_size down,0.01,211,187,required,coarse,none,x\n"
      "pcss,offset,0.01,1e+11,,holds,,,\n"
      "none,zoom,0.01,,10,not served,refused,error,\n");
  ASSERT_EQ(ranges.size(), 4u);
  EXPECT_EQ(ranges[0].cause, "light, on 2%");
  EXPECT_FALSE(ranges[2].ends);
  EXPECT_TRUE(ranges[3].refused);
  EXPECT_EQ(safe_ranges_quote("pcss", ranges),
            "**Safe ranges** ([why](../../docs/measurements/safe-ranges.md#pcss)): `ground` up to "
            "3.2e+05 m, `map_size`\ndown to 210 texels.\n");
  EXPECT_NE(safe_ranges_quote("esm", ranges).find("not measured"), std::string::npos);
  const auto held = read_safe_ranges(
      "technique,axis,gentle_rms,holds,ends,verdict,cause,guard,why\nesm,offset,0.01,1e+11,,holds,,"
      ",\n");
  EXPECT_NE(safe_ranges_quote("esm", held).find("all axes hold"), std::string::npos);
  EXPECT_THROW(read_safe_ranges("technique,axis\n"), Error);
  EXPECT_THROW(read_safe_ranges(""), Error);
  EXPECT_THROW(read_safe_ranges("technique,axis,gentle_rms,holds,ends,verdict,cause,guard,why\n"
                                "pcss,ground,0,much,1,defect,,,\n"),
               Error);
}

}  // namespace
}  // namespace penumbra::experiments::stability
