#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "figures/charts.h"
#include "figures/panels.h"

namespace penumbra::figures {

namespace {

Range range_along(const ScatterAxis& axis, const std::vector<const ScatterPoint*>& points,
                  bool vertical) {
  if (axis.range) return *axis.range;
  std::vector<double> values;
  for (const ScatterPoint* point : points) {
    values.push_back(vertical ? point->y : point->x);
    if (vertical && point->interval)
      values.insert(values.end(), point->interval->begin(), point->interval->end());
  }
  return range_of(values, axis.logarithmic);
}

Scale scale_of(const ScatterAxis& axis, const Range& range, double begin, double end) {
  return {axis.backwards ? range.high : range.low, axis.backwards ? range.low : range.high, begin,
          end, axis.logarithmic};
}

void draw_point(Drawing& drawing, const ScatterPoint& point, const Scale& horizontal,
                const Scale& vertical) {
  if (!horizontal.holds(point.x) || !vertical.holds(point.y)) return;
  const Mark mark = mark_of_series(point.series);
  const double x = horizontal.at(point.x);
  if (point.interval) {
    const auto [least, greatest] = std::minmax({vertical.from, vertical.to});
    const double low = std::clamp((*point.interval)[0], least, greatest);
    const double high = std::clamp((*point.interval)[1], least, greatest);
    drawing.line({x, vertical.at(low)}, {x, vertical.at(high)}, {mark.colour, 0.8});
  }
  drawing.mark({x, vertical.at(point.y)}, mark);
}

std::vector<Tick> ticks_along(const ScatterAxis& axis, const Range& range, double length,
                              double pitch) {
  if (axis.whole_numbers)
    return whole_ticks(static_cast<int>(std::ceil(range.low)),
                       static_cast<int>(std::floor(range.high)), length, pitch);
  return ticks_between(range.low, range.high,
                       std::max<std::size_t>(2, static_cast<std::size_t>(length / pitch)),
                       axis.logarithmic);
}

}  // namespace

std::string draw(const Scatter& chart) {
  Drawing drawing(chart.frame.width_mm);
  std::vector<const ScatterPoint*> points;
  std::vector<std::string> headings;
  bool notes = false;
  for (const auto& panel : chart.panels) {
    headings.push_back(panel.label);
    notes = notes || !panel.note.empty();
    for (const auto& point : panel.points) points.push_back(&point);
  }
  if (points.empty()) {
    drawing.text({0.5 * drawing.width(), 24.0}, chart.frame.empty, {.anchor = Anchor::middle});
    return drawing.svg(40.0, chart.frame.title, chart.frame.description);
  }
  const Range along = range_along(chart.horizontal, points, false);
  const Range up = range_along(chart.vertical, points, true);
  const auto vertical_ticks = ticks_along(chart.vertical, up, 90.0, 16.0);
  const PanelGrid grid =
      lay_out_panels(drawing, headings, chart.horizontal.title, chart.vertical.title,
                     {.least_width = 125.0,
                      .aspect = 0.72,
                      .axis_width = width_of(vertical_ticks) + 6.0,
                      .line_under_heading = notes ? line_height : 0.0});
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    const Box& plot = grid.plots[i];
    const Scale horizontal = scale_of(chart.horizontal, along, plot.left, plot.right);
    const Scale vertical = scale_of(chart.vertical, up, plot.bottom, plot.top);
    draw_vertical_axis(drawing, vertical, vertical_ticks, plot.left, plot.right);
    draw_horizontal_axis(drawing, horizontal,
                         ticks_along(chart.horizontal, along, plot.width(), 26.0), plot.bottom,
                         plot.top);
    if (!chart.panels[i].note.empty())
      drawing.text({plot.left, plot.top - 4.0}, chart.panels[i].note, {.colour = soft_ink});
    for (const auto& point : chart.panels[i].points)
      draw_point(drawing, point, horizontal, vertical);
  }
  return drawing.svg(draw_legend(drawing, chart.series, grid.bottom + 4.0) + 3.0, chart.frame.title,
                     chart.frame.description);
}

namespace {

struct Placed {
  Box box;
  Point baseline;
  Anchor anchor = Anchor::start;
};

/// Places around a point where its name may stand, best first.
std::vector<Placed> places_around(Point at, double width) {
  std::vector<Placed> places;
  for (const double reach : {5.0, 9.0, 14.0}) {
    const auto add = [&](double left, double baseline, Anchor anchor) {
      const double x = anchor == Anchor::start    ? left
                       : anchor == Anchor::middle ? left + 0.5 * width
                                                  : left + width;
      places.push_back({{left, baseline - 0.8 * text_size, left + width, baseline + 2.0},
                        {x, baseline},
                        anchor});
    };
    const double middle = at.y + 0.35 * text_size;
    add(at.x + reach, middle, Anchor::start);
    add(at.x - reach - width, middle, Anchor::end);
    add(at.x - 0.5 * width, at.y - reach, Anchor::middle);
    add(at.x - 0.5 * width, at.y + reach + 0.7 * text_size, Anchor::middle);
    for (const double side : {1.0, -1.0}) {
      const double left = side > 0.0 ? at.x + 0.6 * reach : at.x - 0.6 * reach - width;
      const Anchor anchor = side > 0.0 ? Anchor::start : Anchor::end;
      add(left, at.y - 0.6 * reach, anchor);
      add(left, at.y + 0.6 * reach + 0.7 * text_size, anchor);
    }
  }
  return places;
}

/// A place for every point's name that touches no mark, interval or other name; empty where one
/// finds none.
std::vector<Placed> place_names(const Front& chart, const std::vector<Point>& marks,
                                std::vector<Box> taken, const Box& plot) {
  std::vector<Placed> names;
  for (std::size_t i = 0; i < chart.points.size(); ++i) {
    const double width = text_width(chart.series.at(chart.points[i].series), text_size);
    bool found = false;
    for (const Placed& place : places_around(marks[i], width)) {
      const Box& box = place.box;
      const bool inside = box.left >= plot.left && box.right <= plot.right && box.top >= plot.top &&
                          box.bottom <= plot.bottom;
      if (!inside || std::any_of(taken.begin(), taken.end(),
                                 [&](const Box& other) { return box.overlaps(other); }))
        continue;
      taken.push_back(box);
      names.push_back(place);
      found = true;
      break;
    }
    if (!found) return {};
  }
  return names;
}

/// The front as steps: up to the next point's x nothing better is known.
std::vector<Point> steps_of(const Front& chart, const std::vector<Point>& marks, const Box& plot) {
  std::vector<Point> steps;
  if (chart.front.empty()) return steps;
  for (const std::size_t index : chart.front) {
    const Point& at = marks.at(index);
    if (!steps.empty()) steps.push_back({at.x, steps.back().y});
    steps.push_back(at);
  }
  steps.push_back({plot.right, steps.back().y});
  return steps;
}

}  // namespace

std::string draw(const Front& chart) {
  Drawing drawing(chart.frame.width_mm);
  if (chart.points.empty()) {
    drawing.text({0.5 * drawing.width(), 24.0}, chart.frame.empty, {.anchor = Anchor::middle});
    return drawing.svg(40.0, chart.frame.title, chart.frame.description);
  }
  std::vector<const ScatterPoint*> points;
  for (const auto& point : chart.points) points.push_back(&point);
  const Range along = range_along(chart.horizontal, points, false);
  const Range up = range_along(chart.vertical, points, true);
  const auto vertical_ticks = ticks_along(chart.vertical, up, 140.0, 18.0);
  const PanelGrid grid = lay_out_panels(drawing, {""}, chart.horizontal.title, chart.vertical.title,
                                        {.least_width = drawing.width(),
                                         .aspect = drawing.width() > 300.0 ? 0.5 : 0.8,
                                         .axis_width = width_of(vertical_ticks) + 6.0});
  const Box& plot = grid.plots.front();
  const Scale horizontal = scale_of(chart.horizontal, along, plot.left, plot.right);
  const Scale vertical = scale_of(chart.vertical, up, plot.bottom, plot.top);
  draw_vertical_axis(drawing, vertical, vertical_ticks, plot.left, plot.right);
  draw_horizontal_axis(drawing, horizontal,
                       ticks_along(chart.horizontal, along, plot.width(), 30.0), plot.bottom,
                       plot.top);
  std::vector<Point> marks;
  std::vector<Box> taken;
  for (const auto& point : chart.points) {
    const Point at{horizontal.at(point.x), vertical.at(point.y)};
    marks.push_back(at);
    taken.push_back({at.x - 3.5, at.y - 3.5, at.x + 3.5, at.y + 3.5});
    if (!point.interval) continue;
    const auto [low, high] =
        std::minmax({vertical.at((*point.interval)[0]), vertical.at((*point.interval)[1])});
    taken.push_back({at.x - 0.8, low, at.x + 0.8, high});
  }
  const auto steps = steps_of(chart, marks, plot);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const auto [left, right] = std::minmax(steps[i - 1].x, steps[i].x);
    const auto [top, bottom] = std::minmax(steps[i - 1].y, steps[i].y);
    taken.push_back({left - 0.8, top - 0.8, right + 0.8, bottom + 0.8});
  }
  drawing.path(steps, {soft_ink, 0.9, "4 2"});
  for (const auto& point : chart.points) draw_point(drawing, point, horizontal, vertical);
  const auto names = place_names(chart, marks, std::move(taken), plot);
  double bottom = grid.bottom + 3.0;
  for (std::size_t i = 0; i < names.size(); ++i)
    drawing.text(names[i].baseline, chart.series.at(chart.points[i].series),
                 {.anchor = names[i].anchor});
  if (names.empty()) bottom = draw_legend(drawing, chart.series, grid.bottom + 4.0) + 3.0;
  return drawing.svg(bottom, chart.frame.title, chart.frame.description);
}

std::vector<std::size_t> lower_left_front(const std::vector<ScatterPoint>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(points[a].x, points[a].y) < std::make_pair(points[b].x, points[b].y);
  });
  std::vector<std::size_t> front;
  double best = std::numeric_limits<double>::infinity();
  for (const std::size_t index : order) {
    const bool twin = !front.empty() && points[index].x == points[front.back()].x &&
                      points[index].y == points[front.back()].y;
    if (points[index].y < best || twin) front.push_back(index);
    best = std::min(best, points[index].y);
  }
  return front;
}

}  // namespace penumbra::figures
