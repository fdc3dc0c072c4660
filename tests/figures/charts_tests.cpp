#include "figures/charts.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/figures/xml.h"

namespace penumbra::figures {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<std::string> long_names{
    "Standard shadow map with a linear depth buffer",
    "Percentage-closer filtering 3x3",
    "Percentage-closer filtering, bilinear",
    "Percentage-closer_filtering_bilinear_and_3x3_kernel",
    "Percentage-closer soft shadows (Fernando 2005)",
    "Variance shadow maps <2007> & \"friends\"",
    "Donaudampfschifffahrtsgesellschaftskapitaensmuetze",
    "Penumbra wedges: weiche Schattenvolumen f\xC3\xBCr Fl\xC3\xA4"
    "chenlichter",
    "R\xC3\xA9"
    "f\xC3\xA9rence"};

/// Boxes of all texts, by the widths of DejaVu Sans.
std::vector<Box> text_boxes(const Xml& xml) {
  std::vector<Box> boxes;
  for (const Element& text : xml.named("text")) {
    const double size =
        text.attributes.contains("font-size") ? text.number("font-size") : text_size;
    const double width =
        text_width(text.text, size) * (text.attributes.contains("font-weight") ? 1.12 : 1.0);
    const auto anchor = text.attributes.find("text-anchor");
    double left = text.number("x");
    if (anchor != text.attributes.end()) left -= anchor->second == "end" ? width : 0.5 * width;
    const double base = text.number("y");
    boxes.push_back({left, base - 0.76 * size, left + width, base + 0.22 * size});
  }
  return boxes;
}

/// Texts that touch each other or leave the page.
std::vector<std::string> collisions(const std::string& svg) {
  const Xml xml = parse_xml(svg);
  EXPECT_EQ(xml.error, "") << svg;
  std::vector<std::string> found;
  const auto texts = xml.texts();
  const auto boxes = text_boxes(xml);
  const std::string& view = xml.elements.at(0).attributes.at("viewBox");
  double width = 0.0;
  double height = 0.0;
  std::sscanf(view.c_str(), "0 0 %lf %lf", &width, &height);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[i];
    if (box.left < -0.01 || box.top < -0.01 || box.right > width + 0.01 ||
        box.bottom > height + 0.01)
      found.push_back("outside: " + texts[i]);
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if (box.overlaps(boxes[j])) found.push_back(texts[i] + " | " + texts[j]);
  }
  return found;
}

DotPlot nine_rows(double width_mm) {
  DotPlot plot;
  plot.frame.width_mm = width_mm;
  plot.axis = "mean rank with 95% interval";
  plot.left_end = "the most realistic shadows one can imagine";
  plot.right_end = "not realistic at all, clearly drawn by a computer";
  plot.whole_numbers = Range{1.0, 9.0};
  for (std::size_t i = 0; i < long_names.size(); ++i) {
    const double value = 1.5 + 0.8 * static_cast<double>(i);
    plot.rows.push_back({long_names[i], value, Interval{value - 0.4, value + 0.4}});
  }
  plot.bars = {{"a", {0, 1, 2}}, {"b", {2, 4, 5}}, {"c", {6, 7, 8}}};
  return plot;
}

std::vector<ScatterPoint> nine_points() {
  std::vector<ScatterPoint> points;
  for (std::size_t i = 0; i < long_names.size(); ++i) {
    const double at = static_cast<double>(i);
    points.push_back({std::pow(10.0, 0.3 * at), 9.0 - at, i, Interval{8.5 - at, 9.5 - at}});
  }
  return points;
}

TEST(Charts, NamesThatAreMarkupStayText) {
  DotPlot plot = nine_rows(page_mm);
  plot.rows[0].label = "</text><script>alert(1)</script>";
  plot.rows[1].label = "a & b";
  plot.rows[2].label = std::string("bell \x07, no UTF-8 \xFF, \xEF\xBF\xBF");
  plot.frame.title = "<title> \" ' &amp;";
  const Xml xml = parse_xml(draw(plot));
  EXPECT_EQ(xml.error, "");
  EXPECT_TRUE(xml.named("script").empty());
  EXPECT_THAT(xml.texts(), Contains("</text><script>alert(1)</script>"));
  EXPECT_THAT(xml.texts(), Contains("a & b"));
  EXPECT_THAT(xml.texts(), Contains("bell \uFFFD, no UTF-8 \uFFFD, \uFFFD"));
  EXPECT_EQ(xml.named("title").at(0).text, plot.frame.title);
}

TEST(Charts, ArePrintedAtTheWidthAskedFor) {
  const Xml xml = parse_xml(draw(nine_rows(85.0)));
  EXPECT_EQ(xml.elements.at(0).attributes.at("width"), "85mm");
  double width = 0.0;
  std::sscanf(xml.elements.at(0).attributes.at("viewBox").c_str(), "0 0 %lf", &width);
  EXPECT_NEAR(width, 85.0 / 25.4 * 72.0, 0.01);  // so that a unit is a point
  for (const Element& text : xml.named("text"))
    EXPECT_FALSE(text.attributes.contains("font-size") && text.number("font-size") < 8.0);
  EXPECT_EQ(xml.elements.at(0).attributes.at("font-size"), "8");
}

TEST(Charts, MarksStandWhereTheAxisSays) {
  const Xml xml = parse_xml(draw(nine_rows(85.0)));
  std::map<std::string, double> ticks;
  for (const Element& text : xml.named("text"))
    if (text.text.size() == 1 && std::isdigit(text.text[0])) ticks[text.text] = text.number("x");
  ASSERT_TRUE(ticks.contains("1") && ticks.contains("9"));
  const double unit = (ticks["9"] - ticks["1"]) / 8.0;
  const auto marks = xml.named("circle");
  ASSERT_EQ(marks.size(), 9u);
  for (std::size_t i = 0; i < marks.size(); ++i)
    EXPECT_NEAR(marks[i].number("cx"), ticks["1"] + unit * (0.5 + 0.8 * static_cast<double>(i)),
                0.02);
  for (std::size_t i = 1; i < marks.size(); ++i)
    EXPECT_GT(marks[i].number("cy"), marks[i - 1].number("cy"));
}

TEST(Charts, IntervalsBeyondTheScaleAreCut) {
  DotPlot plot = nine_rows(85.0);
  plot.rows = {
      {"one", 1.2, Interval{-3.0, 5.0}}, {"none", {}, {}}, {"far", 99.0, Interval{98.0, 100.0}}};
  plot.bars.clear();
  const Xml xml = parse_xml(draw(plot));
  double low = 1e9;
  double high = -1e9;
  for (const Element& line : xml.named("line")) {
    low = std::min(low, line.number("x1"));
    high = std::max(high, line.number("x2"));
  }
  const double width = 85.0 / 25.4 * 72.0;
  EXPECT_GT(low, 0.0);
  EXPECT_LT(high, width);
  EXPECT_EQ(xml.named("circle").size(), 1u);
  EXPECT_THAT(xml.texts(), Contains("no value"));
}

TEST(Charts, LongNamesNeverTouchOrLeaveThePage) {
  for (const double width : {column_mm, page_mm}) {
    EXPECT_THAT(collisions(draw(nine_rows(width))), ElementsAre());

    CriticalDifference diagram;
    diagram.frame.width_mm = width;
    diagram.difference = 1.54;
    diagram.note = "Nemenyi, α = 0.05, n = 61";
    for (std::size_t i = 0; i < long_names.size(); ++i)
      diagram.items.push_back({long_names[i], 4.0 + 0.1 * static_cast<double>(i)});
    diagram.groups = {{0, 1, 2, 3, 4, 5, 6, 7, 8}};
    EXPECT_THAT(collisions(draw(diagram)), ElementsAre());

    Histograms histograms;
    histograms.frame.width_mm = width;
    histograms.horizontal = "rank, 1 is the most realistic shadows one can imagine";
    histograms.vertical = "share of answers (%)";
    for (const auto& name : long_names)
      histograms.panels.push_back({name, std::vector<double>(9, 1.0 / 9.0), 5.0});
    EXPECT_THAT(collisions(draw(histograms)), ElementsAre());

    Scatter scatter;
    scatter.frame.width_mm = width;
    scatter.series = long_names;
    for (const char* scene : {"boxes", "a scene whose name is as long as names of scenes can be"})
      scatter.panels.push_back({scene, nine_points(), "ρ = 0.62, τ = 0.44, 9 pictures"});
    scatter.horizontal = {"frame time (ms)", true, false, {}};
    scatter.vertical = {"mean rank with 95% interval (top: most realistic)", false, true,
                        Range{0.6, 9.4}, true};
    EXPECT_THAT(collisions(draw(scatter)), ElementsAre());

    Front front{{}, long_names, nine_points(), {}, scatter.horizontal, scatter.vertical};
    front.frame.width_mm = width;
    front.front = lower_left_front(front.points);
    EXPECT_THAT(collisions(draw(front)), ElementsAre());
    for (std::size_t i = 0; i < front.series.size(); ++i) front.series[i] = "T" + std::to_string(i);
    EXPECT_THAT(collisions(draw(front)), ElementsAre());
  }
}

TEST(Charts, TheCriticalDifferenceIsAsLongAsItsValueOnTheAxis) {
  CriticalDifference diagram;
  diagram.difference = 2.25;
  for (int i = 1; i <= 5; ++i) diagram.items.push_back({"t" + std::to_string(i), double(i)});
  diagram.groups = {{0, 1}, {1, 2}, {3}};
  const Xml xml = parse_xml(draw(diagram));
  std::map<std::string, double> ticks;
  for (const Element& text : xml.named("text"))
    if (text.text.size() == 1) ticks[text.text] = text.number("x");
  const double unit = (ticks.at("5") - ticks.at("1")) / 4.0;
  std::set<double> lengths;
  int groups = 0;
  for (const Element& line : xml.named("line")) {
    lengths.insert(std::round(10.0 * (line.number("x2") - line.number("x1"))) / 10.0);
    groups += line.attributes.at("stroke-width") == "2.6" ? 1 : 0;
  }
  EXPECT_THAT(lengths, Contains(::testing::DoubleNear(2.25 * unit, 0.11)));
  EXPECT_EQ(groups, 2) << "a group of one joins nothing";
}

TEST(Charts, NothingToShowIsSaid) {
  for (const std::string& svg :
       {draw(DotPlot{{"t", "", 85.0, "no worths: not connected"}, {}, "", "", "", {}, {}, {}}),
        draw(CriticalDifference{{"t", "", 85.0, "no worths: not connected"}, {}, 0.0, "", {}}),
        draw(Histograms{{"t", "", 85.0, "no worths: not connected"}, {}, 1, "", ""}),
        draw(Scatter{{"t", "", 85.0, "no worths: not connected"}, {}, {}, {}, {}}),
        draw(Front{{"t", "", 85.0, "no worths: not connected"}, {}, {}, {}, {}, {}})}) {
    const Xml xml = parse_xml(svg);
    EXPECT_EQ(xml.error, "");
    EXPECT_THAT(xml.texts(), ElementsAre("no worths: not connected"));
  }
}

TEST(Charts, NineSeriesAreToldApartWithoutColour) {
  std::set<std::pair<int, bool>> looks;
  for (std::size_t i = 0; i < 16; ++i) {
    const Mark mark = mark_of_series(i);
    looks.emplace(static_cast<int>(mark.shape), mark.filled);
  }
  EXPECT_EQ(looks.size(), 16u);
}

TEST(Charts, TheFrontHoldsWhatNothingBeats) {
  const std::vector<ScatterPoint> points{{1, 9, 0, {}}, {2, 5, 0, {}}, {2, 5, 0, {}}, {3, 6, 0, {}},
                                         {4, 1, 0, {}}, {5, 1, 0, {}}, {2, 7, 0, {}}};
  EXPECT_THAT(lower_left_front(points), ElementsAre(0, 1, 2, 4));
}

TEST(Axes, TicksAreRoundAndWithinTheRange) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks_between(-1.4, 1.4, 6)) labels.push_back(tick.label);
  EXPECT_THAT(labels, ElementsAre("\u22121.0", "\u22120.5", "0.0", "0.5", "1.0"));
  labels.clear();
  for (const Tick& tick : ticks_between(0.8, 300.0, 6, true)) labels.push_back(tick.label);
  EXPECT_THAT(labels, ElementsAre("1", "3", "10", "30", "100", "300"));
  for (const double size : {1e-9, 1e-3, 1.0, 37.0, 1e7, 1e300})
    for (const double low : {-1.0, 0.0, 0.3}) {
      const auto ticks = ticks_between(low * size, size, 5);
      EXPECT_GE(ticks.size(), 2u) << size;
      EXPECT_LE(ticks.size(), 11u) << size;
    }
  EXPECT_EQ(whole_ticks(1, 1, 100.0).size(), 1u);
}

TEST(Axes, EqualValuesStillHaveARange) {
  for (const auto& values :
       {std::vector<double>{}, std::vector<double>{3.0}, std::vector<double>{0.0, 0.0},
        std::vector<double>{std::nan(""), INFINITY}}) {
    for (const bool logarithmic : {false, true}) {
      const Range range = range_of(values, logarithmic);
      EXPECT_LT(range.low, range.high);
      EXPECT_TRUE(std::isfinite(range.low) && std::isfinite(range.high));
      EXPECT_FALSE(ticks_between(range.low, range.high, 5, logarithmic).empty());
    }
  }
}

TEST(Text, WidthsAreThoseOfDejaVuSans) {
  // Advance widths of DejaVu Sans 2.37 in units of 1/2048: H 1540, i 569, m 1995, blank 651.
  EXPECT_NEAR(text_width("H", 2048.0), 1540.0, 1.0);
  EXPECT_NEAR(text_width("im ", 2048.0), 569.0 + 1995.0 + 651.0, 2.0);
}

TEST(Text, WrappedLinesFitAndLoseNothing) {
  for (const auto& name : long_names) {
    for (const double width : {20.0, 45.0, 90.0, 400.0}) {
      std::string joined;
      for (const auto& line : wrapped(name, width, 8.0)) {
        EXPECT_LE(text_width(line, 8.0), width) << line;
        EXPECT_FALSE(line.empty());
        joined += line;
      }
      std::string without_blanks = name;
      std::erase(without_blanks, ' ');
      std::erase(joined, ' ');
      EXPECT_EQ(joined, without_blanks);
    }
  }
  EXPECT_THAT(wrapped("", 10.0, 8.0), ElementsAre(""));
}

TEST(Text, NumbersAreWrittenShortAndWithoutLocale) {
  EXPECT_EQ(number_text(1.5, 2), "1.5");
  EXPECT_EQ(number_text(-0.001, 2), "0");
  EXPECT_EQ(number_text(100.0, 2), "100");
  EXPECT_EQ(fixed_text(-0.004, 2), "0.00");
  EXPECT_EQ(fixed_text(2.0, 2), "2.00");
  EXPECT_EQ(shown_number(-0.95, 2), "\u22120.95");
}

}  // namespace
}  // namespace penumbra::figures
