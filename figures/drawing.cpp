#include "figures/drawing.h"

#include <array>

namespace penumbra::figures {

namespace {

constexpr double points_per_mm = 72.0 / 25.4;

std::string coordinate(double value) {
  return number_text(value, 2);
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

std::string attribute(const char* name, double value) {
  return attribute(name, coordinate(value));
}

std::string stroke_attributes(const Stroke& stroke) {
  return attribute("stroke", stroke.colour) + attribute("stroke-width", stroke.width) +
         (stroke.dash.empty() ? "" : attribute("stroke-dasharray", stroke.dash));
}

/// Corners around `at`, as the attribute of a polygon or path wants them.
std::string around(Point at, double radius, const std::vector<Point>& corners) {
  std::string text;
  for (const Point& corner : corners) {
    text += (text.empty() ? "" : " ") + coordinate(at.x + radius * corner.x) + "," +
            coordinate(at.y + radius * corner.y);
  }
  return text;
}

/// Corners of the closed shapes, about as large to the eye as a circle of radius 1.
std::vector<Point> corners_of(Shape shape) {
  switch (shape) {
    case Shape::square:
      return {{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}};
    case Shape::triangle:
      return {{0.0, -1.2}, {1.15, 0.85}, {-1.15, 0.85}};
    case Shape::down:
      return {{0.0, 1.2}, {1.15, -0.85}, {-1.15, -0.85}};
    case Shape::diamond:
      return {{0.0, -1.3}, {1.3, 0.0}, {0.0, 1.3}, {-1.3, 0.0}};
    case Shape::bar:
      return {{-1.3, -0.45}, {1.3, -0.45}, {1.3, 0.45}, {-1.3, 0.45}};
    default:
      return {};
  }
}

}  // namespace

Mark mark_of_series(std::size_t index) {
  static const std::array<const char*, 7> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                  "#1b1b1b", "#56b4e9", "#e69f00"};
  static const std::array<Shape, 8> shapes{Shape::circle,  Shape::square, Shape::triangle,
                                           Shape::diamond, Shape::down,   Shape::plus,
                                           Shape::cross,   Shape::bar};
  return {shapes[index % shapes.size()], colours[index % colours.size()],
          index / shapes.size() % 2 == 0};
}

Drawing::Drawing(double width_mm) : width_pt(width_mm * points_per_mm) {}

void Drawing::line(Point from, Point to, const Stroke& stroke) {
  body += "<line" + attribute("x1", from.x) + attribute("y1", from.y) + attribute("x2", to.x) +
          attribute("y2", to.y) + stroke_attributes(stroke) + "/>\n";
}

void Drawing::path(const std::vector<Point>& points, const Stroke& stroke) {
  std::string list;
  for (const Point& point : points)
    list += (list.empty() ? "" : " ") + coordinate(point.x) + "," + coordinate(point.y);
  body += "<polyline fill=\"none\" stroke-linejoin=\"round\"" + attribute("points", list) +
          stroke_attributes(stroke) + "/>\n";
}

void Drawing::rectangle(const Box& box, const std::string& fill) {
  body += "<rect" + attribute("x", box.left) + attribute("y", box.top) +
          attribute("width", box.width()) + attribute("height", box.height()) +
          attribute("fill", fill) + "/>\n";
}

void Drawing::mark(Point at, const Mark& mark, double radius) {
  // A white rim keeps marks apart that lie on each other.
  const std::string paint =
      mark.filled
          ? attribute("fill", mark.colour) + " stroke=\"#ffffff\" stroke-width=\"0.5\""
          : " fill=\"#ffffff\"" + attribute("stroke", mark.colour) + attribute("stroke-width", 1.1);
  if (mark.shape == Shape::circle) {
    body += "<circle" + attribute("cx", at.x) + attribute("cy", at.y) + attribute("r", radius) +
            paint + "/>\n";
  } else if (mark.shape == Shape::plus || mark.shape == Shape::cross) {
    const double reach = mark.shape == Shape::plus ? 1.3 * radius : radius;
    const double tilt = mark.shape == Shape::plus ? 0.0 : reach;
    const Stroke stroke{mark.colour, mark.filled ? 1.6 : 0.8};
    line({at.x - reach, at.y - tilt}, {at.x + reach, at.y + tilt}, stroke);
    line({at.x - tilt, at.y + reach}, {at.x + tilt, at.y - reach}, stroke);
  } else {
    body += "<polygon" + attribute("points", around(at, radius, corners_of(mark.shape))) + paint +
            "/>\n";
  }
}

void Drawing::text(Point at, std::string_view text, const TextStyle& style) {
  static const std::array<const char*, 3> anchors{"start", "middle", "end"};
  body += "<text" + attribute("x", at.x) + attribute("y", at.y) +
          (style.anchor == Anchor::start
               ? ""
               : attribute("text-anchor", std::string(anchors[static_cast<int>(style.anchor)]))) +
          (style.size == text_size ? "" : attribute("font-size", style.size)) +
          (style.bold ? attribute("font-weight", std::string("bold")) : "") +
          (style.colour == ink ? "" : attribute("fill", style.colour)) + ">" + escaped(text) +
          "</text>\n";
}

void Drawing::lines(Point at, const std::vector<std::string>& lines, const TextStyle& style) {
  for (const std::string& line : lines) {
    text(at, line, style);
    at.y += line_height * style.size / text_size;
  }
}

std::string Drawing::svg(double height, std::string_view title,
                         std::string_view description) const {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" role=\"img\"" +
         attribute("width", number_text(width_pt / points_per_mm, 2) + "mm") +
         attribute("height", number_text(height / points_per_mm, 2) + "mm") +
         attribute("viewBox", "0 0 " + coordinate(width_pt) + " " + coordinate(height)) +
         attribute("font-family",
                   std::string("Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif")) +
         attribute("font-size", text_size) + attribute("fill", std::string(ink)) + ">\n<title>" +
         escaped(title) + "</title>\n<desc>" + escaped(description) + "</desc>\n<rect" +
         attribute("width", width_pt) + attribute("height", height) + " fill=\"#ffffff\"/>\n" +
         body + "</svg>\n";
}

}  // namespace penumbra::figures
