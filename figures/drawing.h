#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "figures/text.h"

/// Figures that read well in print: pure functions from numbers to SVG with real text. The same
/// input always gives the same bytes.
namespace penumbra::figures {

// Usual widths of printed figures: one column of two, and the whole page.
inline constexpr double column_mm = 85.0;
inline constexpr double page_mm = 178.0;

// Sizes in points (1/72 inch), which are also the units of the SVG's coordinates.
inline constexpr double text_size = 8.0;
inline constexpr double heading_size = 9.0;
inline constexpr double line_height = 9.6;
inline constexpr double hairline = 0.5;
inline constexpr double margin = 3.0;  ///< around everything

// Greys for everything that is not data.
inline constexpr const char* ink = "#1b1b1b";
inline constexpr const char* soft_ink = "#555555";
inline constexpr const char* grid_ink = "#d9d9d9";

struct Point {
  double x = 0.0;
  double y = 0.0;  ///< downwards
};

struct Box {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
  bool overlaps(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = text_size;
  Anchor anchor = Anchor::start;
  bool bold = false;
  std::string colour = ink;
};

struct Stroke {
  std::string colour = ink;
  double width = 0.8;
  std::string dash = {};  ///< lengths of dashes and gaps; empty: solid
};

/// Shapes that are told apart without colour.
enum class Shape { circle, square, triangle, diamond, down, plus, cross, bar };

/// How a series looks.
struct Mark {
  Shape shape = Shape::circle;
  std::string colour = ink;
  bool filled = true;
};

/// The i-th series: colours of Okabe and Ito (2008), which colour-blind people can tell apart,
/// without their yellow, which vanishes on paper; shapes differ as well, so that grey copies can be
/// read. Repeats after 112.
Mark mark_of_series(std::size_t index);

/// An SVG under construction.
class Drawing {
 public:
  explicit Drawing(double width_mm);

  double width() const { return width_pt; }

  void line(Point from, Point to, const Stroke& stroke = {});
  void path(const std::vector<Point>& points, const Stroke& stroke = {});
  void rectangle(const Box& box, const std::string& fill);
  void mark(Point at, const Mark& mark, double radius = 2.6);
  /// `at` is the start, middle or end of the baseline.
  void text(Point at, std::string_view text, const TextStyle& style = {});
  /// Lines below each other; `at` is the baseline of the first.
  void lines(Point at, const std::vector<std::string>& lines, const TextStyle& style = {});

  /// The document, `height` points high; title and description are read by screen readers.
  std::string svg(double height, std::string_view title, std::string_view description) const;

 private:
  double width_pt;
  std::string body;
};

}  // namespace penumbra::figures
