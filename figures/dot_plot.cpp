#include <algorithm>
#include <cmath>

#include "figures/charts.h"

namespace penumbra::figures {

namespace {

constexpr double least_row = 14.0;

/// Where everything of a dot plot is.
struct Layout {
  std::vector<std::vector<std::string>> labels;
  std::vector<double> centres;
  Box plot;
  double bar_pitch = 0.0;
};

double heading_height(const DotPlot& plot) {
  const bool named = std::any_of(plot.bars.begin(), plot.bars.end(),
                                 [](const DotPlot::Bar& bar) { return !bar.name.empty(); });
  return named ? line_height + 2.0 : margin;
}

Layout lay_out(const DotPlot& plot, double width) {
  Layout layout;
  double widest = 0.0;
  for (const auto& row : plot.rows) {
    layout.labels.push_back(wrapped(row.label, 0.4 * width, text_size));
    for (const auto& line : layout.labels.back())
      widest = std::max(widest, text_width(line, text_size));
  }
  const double count = static_cast<double>(plot.bars.size());
  if (count > 0.0) layout.bar_pitch = std::min(8.0, 0.25 * width / count);
  // Half of an end's tick label, and of the widest interval's cap, reach beyond the axis.
  layout.plot = {margin + widest + 8.0, margin + heading_height(plot),
                 width - margin - 6.0 - (count > 0.0 ? count * layout.bar_pitch + 4.0 : 0.0), 0.0};
  double y = layout.plot.top + 2.0;
  for (const auto& lines : layout.labels) {
    const double height =
        std::max(least_row, static_cast<double>(lines.size()) * line_height + 4.0);
    layout.centres.push_back(y + 0.5 * height);
    y += height;
  }
  layout.plot.bottom = y + 2.0;
  return layout;
}

Scale scale_of(const DotPlot& plot, const Layout& layout) {
  Range range;
  if (plot.whole_numbers) {
    range = *plot.whole_numbers;
  } else {
    std::vector<double> values;
    for (const auto& row : plot.rows) {
      if (row.value) values.push_back(*row.value);
      if (row.interval) values.insert(values.end(), row.interval->begin(), row.interval->end());
    }
    if (plot.reference && !values.empty()) values.push_back(*plot.reference);
    range = range_of(values);
  }
  return {range.low, range.high, layout.plot.left, layout.plot.right};
}

void draw_row(Drawing& drawing, const DotPlot::Row& row, const std::vector<std::string>& label,
              const Scale& scale, double y) {
  const double first =
      y + 0.35 * text_size - 0.5 * line_height * static_cast<double>(label.size() - 1);
  drawing.lines({scale.begin - 6.0, first}, label, {.anchor = Anchor::end});
  if (!row.value) {
    drawing.text({0.5 * (scale.begin + scale.end), y + 0.35 * text_size}, "no value",
                 {.anchor = Anchor::middle, .colour = soft_ink});
    return;
  }
  if (row.interval) {
    // An interval may reach beyond the scale of ranks; it is cut at the frame, without its cap.
    const auto low = std::max((*row.interval)[0], scale.from);
    const auto high = std::min((*row.interval)[1], scale.to);
    if (low <= high) {
      drawing.line({scale.at(low), y}, {scale.at(high), y}, {ink, 1.2});
      for (const double end : *row.interval)
        if (scale.holds(end))
          drawing.line({scale.at(end), y - 2.2}, {scale.at(end), y + 2.2}, {ink, 0.8});
    }
  }
  if (scale.holds(*row.value)) drawing.mark({scale.at(*row.value), y}, {Shape::circle, "#0072b2"});
}

/// A thin line from the first to the last row, thick over runs of members: rows between that are no
/// members are beside the thin part.
void draw_bar(Drawing& drawing, const DotPlot::Bar& bar, const Layout& layout, double x) {
  if (bar.rows.empty()) return;
  constexpr double reach = 4.0;
  const Stroke thick{soft_ink, 2.4};
  drawing.line({x, layout.centres.at(bar.rows.front())}, {x, layout.centres.at(bar.rows.back())},
               {soft_ink, hairline});
  for (std::size_t i = 0; i < bar.rows.size();) {
    std::size_t end = i + 1;
    while (end < bar.rows.size() && bar.rows[end] == bar.rows[end - 1] + 1) ++end;
    drawing.line({x, layout.centres.at(bar.rows[i]) - reach},
                 {x, layout.centres.at(bar.rows[end - 1]) + reach}, thick);
    i = end;
  }
  if (!bar.name.empty() && layout.bar_pitch >= text_width(bar.name, text_size))
    drawing.text({x, layout.plot.top - 3.0}, bar.name, {.anchor = Anchor::middle});
}

/// Ends and title below the axis; returns the height used.
double draw_axis_texts(Drawing& drawing, const DotPlot& plot, const Box& box, double y) {
  const double top = y;
  if (!plot.left_end.empty() || !plot.right_end.empty()) {
    // Beside each other under the axis, or where that is too narrow over the whole width.
    const std::string left = "\u2190 " + plot.left_end;
    const std::string right = plot.right_end + " \u2192";
    const bool narrow =
        text_width(left, text_size) + text_width(right, text_size) > box.width() - 6.0;
    const double begin = narrow ? margin : box.left;
    const double end = narrow ? drawing.width() - margin : box.right;
    const auto left_lines = wrapped(left, 0.5 * (end - begin) - 4.0, text_size);
    const auto right_lines = wrapped(right, 0.5 * (end - begin) - 4.0, text_size);
    drawing.lines({begin, y + text_size}, left_lines, {.colour = soft_ink});
    drawing.lines({end, y + text_size}, right_lines, {.anchor = Anchor::end, .colour = soft_ink});
    y += line_height * static_cast<double>(std::max(left_lines.size(), right_lines.size())) + 2.0;
  }
  // The title may be wider than the axis: it has the whole width, as near to the middle as it fits.
  const double width = drawing.width() - 2.0 * margin;
  const auto title = wrapped(plot.axis, width, text_size);
  double widest = 0.0;
  for (const auto& line : title) widest = std::max(widest, text_width(line, text_size));
  const double middle =
      std::clamp(0.5 * (box.left + box.right), margin + 0.5 * widest,
                 std::max(margin + 0.5 * widest, drawing.width() - margin - 0.5 * widest));
  drawing.lines({middle, y + text_size}, title, {.anchor = Anchor::middle});
  y += line_height * static_cast<double>(title.size());
  return y - top;
}

}  // namespace

std::string draw(const DotPlot& plot) {
  Drawing drawing(plot.frame.width_mm);
  if (plot.rows.empty()) {
    drawing.text({0.5 * drawing.width(), 24.0}, plot.frame.empty, {.anchor = Anchor::middle});
    return drawing.svg(40.0, plot.frame.title, plot.frame.description);
  }
  const Layout layout = lay_out(plot, drawing.width());
  const Scale scale = scale_of(plot, layout);
  const Box& box = layout.plot;
  const auto ticks =
      plot.whole_numbers
          ? whole_ticks(static_cast<int>(scale.from), static_cast<int>(scale.to), box.width())
          : ticks_between(scale.from, scale.to,
                          std::max<std::size_t>(2, static_cast<std::size_t>(box.width() / 28.0)));
  draw_horizontal_axis(drawing, scale, ticks, box.bottom, box.top);
  if (plot.reference && scale.holds(*plot.reference)) {
    const double x = scale.at(*plot.reference);
    drawing.line({x, box.top}, {x, box.bottom}, {soft_ink, 0.8, "3 2"});
  }
  for (std::size_t i = 0; i < plot.rows.size(); ++i)
    draw_row(drawing, plot.rows[i], layout.labels[i], scale, layout.centres[i]);
  for (std::size_t i = 0; i < plot.bars.size(); ++i)
    draw_bar(drawing, plot.bars[i], layout,
             box.right + 10.0 + (static_cast<double>(i) + 0.5) * layout.bar_pitch);
  const double below = box.bottom + line_height + 4.0;
  const double used = draw_axis_texts(drawing, plot, box, below);
  return drawing.svg(below + used + margin, plot.frame.title, plot.frame.description);
}

}  // namespace penumbra::figures
