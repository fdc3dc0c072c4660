#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "figures/axis.h"
#include "figures/drawing.h"

/// Kinds of figures. Each takes numbers and names and returns a document; labels are wrapped, never
/// cut. A chart without anything to show is drawn empty with `empty` as its text.
namespace penumbra::figures {

using Interval = std::array<double, 2>;

/// What every chart has.
struct Frame {
  std::string title;        ///< for screen readers and listings; not drawn
  std::string description;  ///< the same content in words
  double width_mm = page_mm;
  std::string empty = "no data";
};

/// Named values below each other with intervals, and bars beside them that join rows which do not
/// differ.
struct DotPlot {
  Frame frame;
  struct Row {
    std::string label;
    std::optional<double> value;  ///< empty: the row has no mark
    std::optional<Interval> interval;
  };
  std::vector<Row> rows;  ///< from the top
  std::string axis;       ///< what the values are
  std::string left_end;   ///< what the axis means at its ends, may be empty
  std::string right_end;
  std::optional<Range> whole_numbers;  ///< the axis has exactly these whole numbers
  std::optional<double> reference;     ///< a dashed line
  struct Bar {
    std::string name;               ///< above the bar, may be empty
    std::vector<std::size_t> rows;  ///< in order
  };
  std::vector<Bar> bars;
};
std::string draw(const DotPlot& plot);

/// Demsar's critical-difference diagram (2006): mean ranks on a line, groups that do not differ
/// joined.
struct CriticalDifference {
  Frame frame;
  struct Item {
    std::string label;
    double rank = 0.0;
  };
  std::vector<Item> items;
  double difference = 0.0;
  std::string note;                              ///< what the difference is
  std::vector<std::vector<std::size_t>> groups;  ///< indices of items
};
std::string draw(const CriticalDifference& diagram);

/// Histograms beside each other with common scales: shares over whole numbers.
struct Histograms {
  Frame frame;
  struct Panel {
    std::string label;
    std::vector<double> shares;  ///< of `first`, `first` + 1, ..; they add up to 1
    std::optional<double> mark;  ///< a mean, as a triangle under the axis
  };
  std::vector<Panel> panels;
  int first = 1;
  std::string horizontal;
  std::string vertical;
};
std::string draw(const Histograms& chart);

struct ScatterPoint {
  double x = 0.0;
  double y = 0.0;
  std::size_t series = 0;
  std::optional<Interval> interval;  ///< of y
};

struct ScatterAxis {
  std::string title;
  bool logarithmic = false;
  bool backwards = false;      ///< small values at the top or right
  std::optional<Range> range;  ///< otherwise that of the values
  bool whole_numbers = false;  ///< ticks at the whole numbers of the range
};

/// Points in panels with common series; a legend below tells marks apart.
struct Scatter {
  Frame frame;
  std::vector<std::string> series;
  struct Panel {
    std::string label;
    std::vector<ScatterPoint> points;
    std::string note;  ///< under the label
  };
  std::vector<Panel> panels;
  ScatterAxis horizontal;
  ScatterAxis vertical;
};
std::string draw(const Scatter& chart);

/// One panel of named points and the line of those that no other beats in both directions.
/// Labels are beside points where all find room, otherwise in a legend.
struct Front {
  Frame frame;
  std::vector<std::string> series;
  std::vector<ScatterPoint> points;
  std::vector<std::size_t> front;  ///< indices of points, by x
  ScatterAxis horizontal;
  ScatterAxis vertical;
};
std::string draw(const Front& chart);

/// Named rows and columns of shaded cells with a word in each.
struct HeatMap {
  Frame frame;
  struct Cell {
    std::optional<double> shade;  ///< 0 dark to 1 white; empty: left blank
    std::string text;
  };
  struct Row {
    std::string label;
    std::vector<Cell> cells;  ///< one a column
  };
  std::vector<std::string> columns;
  std::vector<Row> rows;
  std::string low, high;  ///< what the darkest and the lightest shade mean
};
std::string draw(const HeatMap& chart);

/// Indices of points that none beats: none is at most as large in both coordinates and smaller in
/// one. By x, then y.
std::vector<std::size_t> lower_left_front(const std::vector<ScatterPoint>& points);

}  // namespace penumbra::figures
