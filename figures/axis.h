#pragma once

#include <optional>
#include <string>
#include <vector>

#include "figures/drawing.h"

namespace penumbra::figures {

/// Values along one direction of a drawing: `from` lies at `begin`, `to` at `end` (points). Either
/// may be the larger, so that axes can run backwards. Logarithmic scales need positive values.
struct Scale {
  double from = 0.0;
  double to = 1.0;
  double begin = 0.0;
  double end = 1.0;
  bool logarithmic = false;

  double at(double value) const;
  bool holds(double value) const;
};

struct Tick {
  double value = 0.0;
  std::string label;  ///< empty: no text
};

/// Round values (1, 2 or 5 times a power of ten) within [low, high], at most `most` of them with a
/// label.
std::vector<Tick> ticks_between(double low, double high, std::size_t most,
                                bool logarithmic = false);

/// Whole numbers from `low` to `high`; those with a label are at least `pitch` points apart.
std::vector<Tick> whole_ticks(int low, int high, double length, double pitch = 12.0);

/// Limits with a little air around all finite values, so that marks do not lie on the frame. Equal
/// or no values give an interval around them that is not empty.
struct Range {
  double low = 0.0;
  double high = 1.0;
};
Range range_of(const std::vector<double>& values, bool logarithmic = false);

/// Line, ticks and labels of a horizontal axis at `y`, and grid lines up to `grid_top`.
void draw_horizontal_axis(Drawing& drawing, const Scale& scale, const std::vector<Tick>& ticks,
                          double y, std::optional<double> grid_top);

/// The same of a vertical axis at `x`, labels on its left, grid lines up to `grid_right`.
void draw_vertical_axis(Drawing& drawing, const Scale& scale, const std::vector<Tick>& ticks,
                        double x, std::optional<double> grid_right);

/// Width of the widest label.
double width_of(const std::vector<Tick>& ticks);

}  // namespace penumbra::figures
