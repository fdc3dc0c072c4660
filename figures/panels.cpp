#include "figures/panels.h"

#include <algorithm>
#include <cmath>

namespace penumbra::figures {

namespace {

constexpr double gap = 10.0;

}  // namespace

PanelGrid lay_out_panels(Drawing& drawing, const std::vector<std::string>& headings,
                         const std::string& horizontal, const std::string& vertical,
                         const PanelNeeds& needs) {
  PanelGrid grid;
  const double left = margin;
  const double room = drawing.width() - left - margin - 4.0;
  const auto fitting = static_cast<std::size_t>((room + gap) / (needs.least_width + gap));
  grid.columns = std::clamp<std::size_t>(fitting, 1, std::max<std::size_t>(1, headings.size()));
  // Rows as full as they can be: four panels in two rows of two, not three and one.
  const std::size_t rows = (headings.size() + grid.columns - 1) / grid.columns;
  if (rows > 0) grid.columns = (headings.size() + rows - 1) / rows;
  const auto columns = static_cast<double>(grid.columns);
  const double cell = (room - gap * (columns - 1.0)) / columns;
  const double width = cell - needs.axis_width;
  double y = margin;
  if (!vertical.empty()) {  // written flat above the panels: read without turning the head
    const auto title = wrapped(vertical, room, text_size);
    drawing.lines({left, y + text_size}, title, {.colour = soft_ink});
    y += line_height * static_cast<double>(title.size()) + 5.0;
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t first = row * grid.columns;
    const std::size_t last = std::min(headings.size(), first + grid.columns);
    std::size_t lines = 0;
    for (std::size_t i = first; i < last; ++i) {
      grid.headings.push_back(wrapped(headings[i], width / 1.15, text_size));  // bold is wider
      if (!headings[i].empty()) lines = std::max(lines, grid.headings.back().size());
    }
    const double top =
        y + line_height * static_cast<double>(lines) + 3.0 + needs.line_under_heading;
    for (std::size_t i = first; i < last; ++i) {
      const double x = left + static_cast<double>(i - first) * (cell + gap) + needs.axis_width;
      grid.plots.push_back({x, top, x + width, top + needs.aspect * width});
      if (!headings[i].empty()) drawing.lines({x, y + text_size}, grid.headings[i], {.bold = true});
    }
    y = top + needs.aspect * width + needs.axis_height + 6.0;
  }
  const auto title = wrapped(horizontal, room, text_size);
  drawing.lines({left + 0.5 * room, y + text_size - 3.0}, title, {.anchor = Anchor::middle});
  grid.bottom = y + line_height * static_cast<double>(title.size());
  return grid;
}

double draw_legend(Drawing& drawing, const std::vector<std::string>& series, double top) {
  constexpr double mark_room = 11.0;
  const double room = drawing.width() - 2.0 * margin;
  double widest = 0.0;
  for (const auto& name : series) widest = std::max(widest, text_width(name, text_size));
  const double cell = std::min(room, widest + mark_room + 8.0);
  const auto fitting = std::max<std::size_t>(1, static_cast<std::size_t>(room / cell));
  const std::size_t rows = (series.size() + fitting - 1) / fitting;
  const std::size_t columns = rows == 0 ? 1 : (series.size() + rows - 1) / rows;
  double y = top;
  for (std::size_t first = 0; first < series.size(); first += columns) {
    std::size_t lines = 1;
    for (std::size_t i = first; i < std::min(series.size(), first + columns); ++i) {
      const double x = margin + static_cast<double>(i - first) * cell;
      const auto label = wrapped(series[i], room - mark_room, text_size);
      drawing.mark({x + 4.0, y + text_size - 2.8}, mark_of_series(i));
      drawing.lines({x + mark_room, y + text_size}, label);
      lines = std::max(lines, label.size());
    }
    y += line_height * static_cast<double>(lines) + 1.5;
  }
  return y;
}

}  // namespace penumbra::figures
