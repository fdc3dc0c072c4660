#include "scenes/built_in/car_parts.h"

#include <algorithm>
#include <cmath>

#include "scenes/generators/noise.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

constexpr double front_axle = 1.22, rear_axle = -1.20, wheel_radius = 0.31, arch_radius = 0.385;
constexpr double sill = 0.24;

/// Points of a Catmull-Rom curve through the given ones, `steps` to each piece.
std::vector<glm::dvec2> curve(const std::vector<glm::dvec2>& through, int steps) {
  std::vector<glm::dvec2> points;
  const auto at = [&](std::ptrdiff_t i) {
    return through[static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(through.size()) - 1))];
  };
  for (std::ptrdiff_t i = 0; i + 1 < static_cast<std::ptrdiff_t>(through.size()); ++i)
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const glm::dvec2 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
      points.push_back(0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t +
                              (3.0 * b - a - 3.0 * c + d) * t * t * t));
    }
  points.push_back(through.back());
  return points;
}

/// Side view of the body below the windows, counter-clockwise from the rear sill: along the bottom
/// with both wheel arches, up the nose, back over bonnet and boot.
std::vector<glm::dvec2> side_view() {
  std::vector<glm::dvec2> outline = {{-1.80, sill + 0.06}};
  for (const double axle : {rear_axle, front_axle})
    for (int i = 0; i <= 14; ++i) {
      const glm::dvec2 c = circle(180.0 * i / 14);
      outline.emplace_back(axle - arch_radius * c.x, sill + 0.02 + arch_radius * c.y);
    }
  outline.emplace_back(1.78, sill + 0.05);
  const std::vector<glm::dvec2> upper = curve({{1.86, 0.30},
                                               {1.93, 0.45},
                                               {1.90, 0.62},
                                               {1.74, 0.75},
                                               {1.30, 0.83},
                                               {0.75, 0.89},
                                               {-0.2, 0.915},
                                               {-1.1, 0.90},
                                               {-1.55, 0.86},
                                               {-1.82, 0.76},
                                               {-1.92, 0.60},
                                               {-1.93, 0.42},
                                               {-1.87, 0.32}},
                                              4);
  outline.insert(outline.end(), upper.begin(), upper.end());
  return outline;
}

/// How wide the body is at a place of its side view, as a share of the greatest half width.
double narrowing(const glm::dvec2& p) {
  const double along = std::abs(p.x) / 1.95, above = std::max(0.0, p.y - 0.55),
               below = std::max(0.0, 0.5 - p.y);
  return 1.0 - 0.16 * along * along * along * along - 0.30 * above * above - 0.35 * below * below;
}

Solid body() {
  const std::vector<glm::dvec2> outline = side_view();
  // Across the car: the outline shrinks a little at both sides, which rounds the edges.
  const double across[][2] = {{-1.0, 0.050},   {-0.985, 0.018}, {-0.955, 0.004}, {-0.90, 0.0},
                              {-0.45, -0.012}, {0.0, -0.018},   {0.45, -0.012},  {0.90, 0.0},
                              {0.955, 0.004},  {0.985, 0.018},  {1.0, 0.050}};
  std::vector<std::vector<glm::dvec3>> rings;
  for (const auto& [share, inset] : across) {
    std::vector<glm::dvec3> ring;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 before = outline[(i + outline.size() - 1) % outline.size()];
      const glm::dvec2 after = outline[(i + 1) % outline.size()];
      const glm::dvec2 along = glm::normalize(after - before);
      const bool below = outline[i].y < 0.66 && std::abs(outline[i].x) < 1.75;
      const glm::dvec2 p =
          outline[i] + (below ? std::max(inset, 0.0) : inset) * glm::dvec2(-along.y, along.x);
      ring.emplace_back(p, 0.82 * share * narrowing(p));
    }
    rings.push_back(ring);
  }
  return loft(rings);
}

/// Rounded oblong in the horizontal plane, counter-clockwise seen from above, of 4 * corner points.
std::vector<glm::dvec3> oblong(double rear, double front, double half_width, double y,
                               double radius) {
  std::vector<glm::dvec3> ring;
  const int corner = 6;
  const glm::dvec2 centers[4] = {{front - radius, -(half_width - radius)},
                                 {rear + radius, -(half_width - radius)},
                                 {rear + radius, half_width - radius},
                                 {front - radius, half_width - radius}};
  for (int q = 0; q < 4; ++q)
    for (int i = 0; i < corner; ++i) {
      // From +x over -z, which is counter-clockwise seen from above.
      const glm::dvec2 c = circle(90.0 * q + 90.0 * i / (corner - 1));
      // Windscreen and rear window bulge outwards a little.
      const double bulge =
          0.05 * (1.0 - (centers[q].y - radius * c.y) * (centers[q].y - radius * c.y) /
                            (half_width * half_width));
      ring.emplace_back(centers[q].x + radius * c.x + (c.x > 0.0 ? bulge : -bulge) * std::abs(c.x),
                        y, centers[q].y - radius * c.y);
    }
  return ring;
}

/// One ring of the cabin at a height share of 0 (belt line) to 1 (edge of the roof), `grow` metres
/// out.
std::vector<glm::dvec3> cabin_ring(double t, double grow) {
  return oblong(-1.50 + 0.38 * t - grow, 0.86 - 0.66 * t + grow,
                0.735 - 0.15 * t + 0.02 * t * (1.0 - t) * 4.0 + grow, 0.86 + 0.47 * t,
                0.22 - 0.02 * t);
}

void add_cabin(Mesh& mesh, const CarLooks& looks) {
  add_part(mesh,
           loft({cabin_ring(0.0, 0.0), cabin_ring(0.25, 0.0), cabin_ring(0.5, 0.0),
                 cabin_ring(0.75, 0.0), cabin_ring(1.0, 0.0)}),
           looks.glass, glm::dmat4(1.0), 50.0);
  const auto roof_ring = [](double grow, double y) {
    std::vector<glm::dvec3> ring = cabin_ring(0.93, grow);
    for (glm::dvec3& p : ring) p.y = y;
    return ring;
  };
  add_part(mesh,
           loft({roof_ring(-0.02, 1.285), roof_ring(0.018, 1.29), roof_ring(0.022, 1.315),
                 roof_ring(-0.01, 1.352), roof_ring(-0.07, 1.382), roof_ring(-0.16, 1.405),
                 roof_ring(-0.29, 1.418)}),
           looks.paint, glm::dmat4(1.0), 60.0);
  // Pillars follow the glass from belt to roof at chosen points of its rings.
  for (const auto& [k, width] :
       {std::pair<std::size_t, double>{3, 0.075}, {8, 0.13}, {15, 0.13}, {20, 0.075}}) {
    std::vector<glm::dvec3> path;
    for (const double t : {-0.06, 0.25, 0.5, 0.75, 0.97}) path.push_back(cabin_ring(t, -0.012)[k]);
    add_part(mesh, tube(path, std::vector<double>(5, 0.5 * width), 10), looks.paint,
             glm::dmat4(1.0), 60.0);
  }
  for (const double side : {-1.0, 1.0}) {
    std::vector<glm::dvec3> path;
    for (const double t : {-0.06, 0.25, 0.5, 0.75, 0.97})
      path.emplace_back(-0.32 + 0.04 * t, 0.86 + 0.47 * t,
                        side * (0.718 - 0.15 * t + 0.02 * t * (1.0 - t) * 4.0));
    add_part(mesh, tube(path, std::vector<double>(5, 0.035), 8), looks.paint, glm::dmat4(1.0),
             60.0);
  }
}

void add_wheels(Mesh& mesh, const CarLooks& looks) {
  for (const double x : {rear_axle, front_axle})
    for (const double side : {-1.0, 1.0}) {
      // Axis along z, the outer side where the lathe goes up.
      const glm::dmat4 where = move({x, wheel_radius, side * 0.60}) * turn_x(90.0 * side);
      add_part(mesh,
               lathe({{0.0, 0.0},
                      {0.24, 0.0},
                      {0.285, 0.015},
                      {0.31, 0.05},
                      {0.31, 0.14},
                      {0.29, 0.175},
                      {0.245, 0.185},
                      {0.215, 0.18},
                      {0.21, 0.13},
                      {0.0, 0.13}},
                     36),
               looks.rubber, where, 40.0);
      add_part(
          mesh,
          ring({{0.17, 0.12}, {0.208, 0.12}, {0.214, 0.178}, {0.200, 0.184}, {0.185, 0.165}}, 36),
          looks.chrome, where, 30.0);
      add_part(
          mesh,
          lathe({{0.0, 0.125}, {0.09, 0.125}, {0.085, 0.165}, {0.06, 0.182}, {0.0, 0.188}}, 24),
          looks.chrome, where, 40.0);
      for (int i = 0; i < 7; ++i)
        add_part(mesh, bar({0.05, 0.155, 0.0}, {0.19, 0.145, 0.0}, 0.045, 0.03), looks.chrome,
                 where * turn_y(360.0 * i / 7));
    }
  // What is seen through the arches.
  for (const double x : {rear_axle, front_axle})
    add_part(
        mesh,
        box({x - arch_radius - 0.03, sill + 0.02, -0.58}, {x + arch_radius + 0.03, 0.70, 0.58}),
        looks.rubber);
  add_part(mesh, box({-1.55, sill - 0.05, -0.60}, {1.60, sill + 0.04, 0.60}), looks.rubber);
}

/// Bumper: a round bar that follows the plan of nose or tail.
void add_bumper(Mesh& mesh, const Look& look, double end, double y) {
  std::vector<glm::dvec3> path;
  std::vector<double> radii;
  for (int i = 0; i <= 14; ++i) {
    const double s = -1.0 + 2.0 * i / 14;
    path.emplace_back((end > 0.0 ? 1.0 : -1.0) * (std::abs(end) - 0.02 - 0.19 * s * s * s * s), y,
                      0.76 * s);
    radii.push_back(i == 0 || i == 14 ? 0.035 : 0.05);
  }
  add_part(mesh, tube(path, radii, 10), look, glm::dmat4(1.0), 50.0);
}

void add_details(Mesh& mesh, const CarLooks& looks) {
  add_bumper(mesh, looks.chrome, 1.99, 0.40);
  add_bumper(mesh, looks.chrome, -1.985, 0.42);
  for (const double side : {-1.0, 1.0}) {
    add_part(mesh, sphere(1.0, 24, 14), looks.chrome,
             move({1.815, 0.615, side * 0.53}) * turn_z(-14.0) * stretch({0.085, 0.125, 0.125}),
             60.0);
    add_part(mesh, sphere(1.0, 24, 14), looks.lamp,
             move({1.838, 0.612, side * 0.53}) * turn_z(-14.0) * stretch({0.085, 0.108, 0.108}),
             60.0);
    add_part(
        mesh,
        rounded_box({-1.945, 0.56, side * 0.56 - 0.09}, {-1.82, 0.70, side * 0.56 + 0.09}, 0.03, 2),
        looks.tail_lamp);
    // Mirror and its foot, door handle, sill trim, the gaps around the door.
    add_part(
        mesh,
        rounded_box({0.52, 0.93, side * 0.86 - 0.075}, {0.60, 1.04, side * 0.86 + 0.075}, 0.03, 2),
        looks.paint);
    add_part(mesh, bar({0.56, 0.90, side * 0.74}, {0.56, 0.955, side * 0.82}, 0.03, 0.03),
             looks.chrome);
    add_part(mesh,
             rounded_box({-0.24, 0.755, side * 0.812 - 0.012}, {-0.06, 0.785, side * 0.812 + 0.012},
                         0.008, 1),
             looks.chrome);
  }
  // The grille follows the nose, which leans back above 0.45 m.
  for (int i = 0; i < 5; ++i)
    add_part(mesh,
             rounded_box({1.86, 0.49 + 0.036 * i, -0.36},
                         {1.972 - 0.011 * i, 0.510 + 0.036 * i, 0.36}, 0.006, 1),
             i % 2 ? looks.rubber : looks.chrome);
  add_part(mesh, box({1.90, 0.335, -0.26}, {2.056, 0.445, 0.26}), looks.lamp);
  add_part(mesh, box({-1.955, 0.50, -0.26}, {-1.90, 0.61, 0.26}), looks.lamp);
}

}  // namespace

Mesh make_car_mesh(const CarLooks& looks) {
  Mesh mesh;
  add_part(mesh, body(), looks.paint, glm::dmat4(1.0), 38.0);
  add_cabin(mesh, looks);
  add_wheels(mesh, looks);
  add_details(mesh, looks);
  return mesh;
}

}  // namespace penumbra::scenes
