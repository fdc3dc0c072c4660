#include <algorithm>
#include <cmath>
#include <numeric>

#include "figures/charts.h"

namespace penumbra::figures {

namespace {

constexpr double group_pitch = 6.0;

struct Label {
  std::size_t item = 0;
  std::vector<std::string> lines;
  double y = 0.0;
};

std::string named(const CriticalDifference::Item& item) {
  return item.label + " " + fixed_text(item.rank, 2);
}

double widest_of(const std::vector<Label>& labels) {
  double widest = 0.0;
  for (const Label& label : labels)
    for (const auto& line : label.lines) widest = std::max(widest, text_width(line, text_size));
  return widest;
}

/// Stacks labels below `top`; returns the bottom of the last.
double stack(std::vector<Label>& labels, double top) {
  for (Label& label : labels) {
    const double height = line_height * static_cast<double>(label.lines.size()) + 4.0;
    label.y = top + 0.5 * height;
    top += height;
  }
  return top;
}

void draw_labels(Drawing& drawing, const CriticalDifference& diagram, const Scale& scale,
                 const std::vector<Label>& labels, bool left, double axis_y) {
  const double edge = left ? scale.begin - 6.0 : scale.end + 6.0;
  for (const Label& label : labels) {
    const double x = scale.at(diagram.items[label.item].rank);
    drawing.path({{x, axis_y}, {x, label.y}, {edge, label.y}}, {ink, 0.7});
    const double first = label.y + 0.35 * text_size -
                         0.5 * line_height * static_cast<double>(label.lines.size() - 1);
    drawing.lines({left ? edge - 2.5 : edge + 2.5, first}, label.lines,
                  {.anchor = left ? Anchor::end : Anchor::start});
  }
}

/// Groups of two and more as rows of bars: each in the first row where it touches no other.
std::size_t draw_groups(Drawing& drawing, const CriticalDifference& diagram, const Scale& scale,
                        double top) {
  std::vector<Interval> spans;
  for (const auto& group : diagram.groups) {
    if (group.size() < 2) continue;
    Interval span{diagram.items.at(group[0]).rank, diagram.items.at(group[0]).rank};
    for (const std::size_t item : group) {
      span[0] = std::min(span[0], diagram.items.at(item).rank);
      span[1] = std::max(span[1], diagram.items.at(item).rank);
    }
    spans.push_back(span);
  }
  std::sort(spans.begin(), spans.end());
  std::vector<double> ends;  // of the last bar of each row, points
  for (const Interval& span : spans) {
    const double left = scale.at(span[0]) - 2.5;
    const double right = scale.at(span[1]) + 2.5;
    std::size_t row = 0;
    while (row < ends.size() && ends[row] + 4.0 > left) ++row;
    if (row == ends.size()) ends.push_back(0.0);
    ends[row] = right;
    const double y = top + group_pitch * static_cast<double>(row);
    drawing.line({left, y}, {right, y}, {ink, 2.6});
  }
  return ends.size();
}

void draw_difference(Drawing& drawing, const CriticalDifference& diagram, const Scale& scale) {
  const double y = margin + line_height + 4.0;
  const double end = scale.at(scale.from + diagram.difference);
  drawing.line({scale.begin, y}, {end, y}, {ink, 1.2});
  for (const double x : {scale.begin, end}) drawing.line({x, y - 2.5}, {x, y + 2.5}, {ink, 1.0});
  drawing.text({margin, margin + text_size},
               "CD = " + fixed_text(diagram.difference, 2) +
                   (diagram.note.empty() ? "" : " (" + diagram.note + ")"));
}

}  // namespace

std::string draw(const CriticalDifference& diagram) {
  Drawing drawing(diagram.frame.width_mm);
  if (diagram.items.size() < 2) {
    drawing.text({0.5 * drawing.width(), 24.0}, diagram.frame.empty, {.anchor = Anchor::middle});
    return drawing.svg(40.0, diagram.frame.title, diagram.frame.description);
  }
  std::vector<std::size_t> order(diagram.items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return diagram.items[a].rank < diagram.items[b].rank;
  });
  // The better half stands on the left, best on top; the other on the right, worst on top.
  const double label_width = 0.27 * drawing.width();
  std::vector<Label> left;
  std::vector<Label> right;
  for (std::size_t i = 0; i < order.size(); ++i) {
    Label label{order[i], wrapped(named(diagram.items[order[i]]), label_width, text_size)};
    if (i < (order.size() + 1) / 2)
      left.push_back(std::move(label));
    else
      right.insert(right.begin(), std::move(label));
  }
  const Scale scale{1.0, static_cast<double>(order.size()), margin + widest_of(left) + 10.0,
                    drawing.width() - margin - widest_of(right) - 10.0};
  const double axis_y = margin + 3.0 * line_height + 6.0;
  const auto ticks = whole_ticks(1, static_cast<int>(order.size()), scale.end - scale.begin);
  drawing.line({scale.begin, axis_y}, {scale.end, axis_y}, {ink, 1.0});
  for (const Tick& tick : ticks) {
    const double x = scale.at(tick.value);
    drawing.line({x, axis_y - 3.0}, {x, axis_y}, {ink, 1.0});
    if (!tick.label.empty())
      drawing.text({x, axis_y - 5.0}, tick.label, {.anchor = Anchor::middle});
  }
  draw_difference(drawing, diagram, scale);
  const std::size_t rows = draw_groups(drawing, diagram, scale, axis_y + 7.0);
  const double top = axis_y + 6.0 + group_pitch * static_cast<double>(rows);
  const double bottom = std::max(stack(left, top), stack(right, top));
  draw_labels(drawing, diagram, scale, left, true, axis_y);
  draw_labels(drawing, diagram, scale, right, false, axis_y);
  return drawing.svg(bottom + margin, diagram.frame.title, diagram.frame.description);
}

}  // namespace penumbra::figures
