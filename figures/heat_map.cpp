#include <algorithm>
#include <cmath>
#include <cstdio>

#include "figures/charts.h"

namespace penumbra::figures {
namespace {

constexpr double row_height = 14.0;
constexpr double cell_text = 6.0;
constexpr double cell_gap = 1.0;

/// From a dark red to white: light enough for black text above a third, white text below.
std::string colour_of(double shade) {
  const double t = std::clamp(shade, 0.0, 1.0);
  const auto mix = [&](double dark, double light) {
    return static_cast<int>(std::lround(dark + (light - dark) * t));
  };
  char text[8];
  std::snprintf(text, sizeof(text), "#%02x%02x%02x", mix(150, 250), mix(35, 249), mix(40, 245));
  return text;
}

const char* text_colour(double shade) {
  return shade < 0.35 ? "#ffffff" : ink;
}

void draw_scale(Drawing& drawing, const HeatMap& chart, double left, double top) {
  double x = left;
  drawing.text({x, top + 8.0}, chart.low);
  x += text_width(chart.low, text_size) + 6.0;
  for (int i = 0; i <= 10; ++i, x += 10.0)
    drawing.rectangle({x, top, x + 10.0, top + 10.0}, colour_of(0.1 * i));
  drawing.text({x + 6.0, top + 8.0}, chart.high);
}

}  // namespace

std::string draw(const HeatMap& chart) {
  Drawing drawing(chart.frame.width_mm);
  if (chart.rows.empty() || chart.columns.empty()) {
    drawing.text({0.5 * drawing.width(), 24.0}, chart.frame.empty, {.anchor = Anchor::middle});
    return drawing.svg(40.0, chart.frame.title, chart.frame.description);
  }
  double left = 0.0;
  for (const auto& row : chart.rows) left = std::max(left, text_width(row.label, text_size));
  left = std::min(left, 0.3 * drawing.width()) + 6.0;
  const double width = (drawing.width() - left) / static_cast<double>(chart.columns.size());

  // Names of columns, standing on the first row.
  std::vector<std::vector<std::string>> names;
  std::size_t lines = 0;
  for (const std::string& column : chart.columns) {
    names.push_back(wrapped(column, width - 2.0, cell_text));
    lines = std::max(lines, names.back().size());
  }
  const double cell_line = line_height * cell_text / text_size;
  double top = 4.0 + static_cast<double>(lines) * cell_line;
  for (std::size_t c = 0; c < names.size(); ++c)
    drawing.lines({left + width * (static_cast<double>(c) + 0.5),
                   top - 2.0 - cell_line * (static_cast<double>(names[c].size()) - 1.0)},
                  names[c], {.size = cell_text, .anchor = Anchor::middle});

  for (const auto& row : chart.rows) {
    const auto label = wrapped(row.label, left - 6.0, text_size);
    const double height =
        std::max(row_height, line_height * static_cast<double>(label.size()) + 2.0);
    drawing.lines({0.0, top + 10.0}, label);
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      const HeatMap::Cell& cell = row.cells[c];
      const double x = left + width * static_cast<double>(c);
      if (cell.shade)
        drawing.rectangle({x, top, x + width - cell_gap, top + height - cell_gap},
                          colour_of(*cell.shade));
      drawing.text({x + 0.5 * (width - cell_gap), top + 0.5 * height + 2.0}, cell.text,
                   {.size = cell_text,
                    .anchor = Anchor::middle,
                    .colour = text_colour(cell.shade.value_or(1.0))});
    }
    top += height;
  }
  draw_scale(drawing, chart, left, top + 8.0);
  return drawing.svg(top + 24.0, chart.frame.title, chart.frame.description);
}

}  // namespace penumbra::figures
