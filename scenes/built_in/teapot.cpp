#include "scenes/built_in/built_in.h"
#include "scenes/generators/random.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {
namespace {

/// Points of a smooth curve through the given ones (Catmull and Rom 1974), `steps` to each piece.
std::vector<glm::dvec3> curve(const std::vector<glm::dvec3>& through, int steps) {
  std::vector<glm::dvec3> points;
  const auto at = [&](std::size_t i, int by) {
    const auto k = static_cast<std::ptrdiff_t>(i) + by;
    const auto last = static_cast<std::ptrdiff_t>(through.size()) - 1;
    return through[static_cast<std::size_t>(std::min(std::max<std::ptrdiff_t>(k, 0), last))];
  };
  for (std::size_t i = 0; i + 1 < through.size(); ++i)
    for (int step = 0; step < steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      const glm::dvec3 a = at(i, -1), b = at(i, 0), c = at(i, 1), d = at(i, 2);
      points.push_back(0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t +
                              (3.0 * (b - c) + d - a) * t * t * t));
    }
  points.push_back(through.back());
  return points;
}

std::vector<glm::dvec2> profile(const std::vector<glm::dvec2>& through, int steps) {
  std::vector<glm::dvec3> points;
  for (const glm::dvec2& p : through) points.emplace_back(p, 0.0);
  std::vector<glm::dvec2> result;
  for (const glm::dvec3& p : curve(points, steps)) result.emplace_back(std::max(p.x, 0.0), p.y);
  return result;
}

/// Radii that go evenly from one value to another.
std::vector<double> between(double first, double last, std::size_t count) {
  std::vector<double> radii;
  for (std::size_t i = 0; i < count; ++i)
    radii.push_back(first +
                    (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
  return radii;
}

}  // namespace

/// A teapot of round parts on a table: body, lid, knob, spout and handle, each closed. Lengths are
/// in decimetres of a big pot, so that 1 m is about its radius.
Scene make_teapot() {
  SceneBuilder b("teapot", "A teapot on a table");
  const Look table = b.look("table", {0.95f, 0.90f, 0.84f}, b.texture("wood", 91), 2.2);
  const Look glaze = b.look("glaze", {0.16f, 0.34f, 0.46f}, -1, 1.0, 0.16f, 140.0f);
  const Look rim = b.look("rim", {0.72f, 0.62f, 0.42f}, -1, 1.0, 0.14f, 90.0f);
  b.ground({-8.0, -8.0}, {8.0, 8.0}, table, "table");
  Mesh pot;
  add_part(pot,
           lathe(profile({{0.62, 0.02},
                          {0.70, 0.08},
                          {1.02, 0.42},
                          {1.12, 0.78},
                          {1.00, 1.14},
                          {0.74, 1.38},
                          {0.66, 1.44}},
                         6),
                 64),
           glaze, glm::dmat4(1.0), 50.0);
  add_part(pot, torus(0.665, 0.035, 64, 12), rim, move({0.0, 1.44, 0.0}), 60.0);
  add_part(
      pot,
      lathe(profile({{0.62, 1.43}, {0.60, 1.49}, {0.42, 1.58}, {0.16, 1.64}, {0.07, 1.68}}, 5), 48),
      glaze, glm::dmat4(1.0), 50.0);
  add_part(pot, sphere(0.12, 32, 16), rim, move({0.0, 1.78, 0.0}), 60.0);
  const auto spout = curve({{0.85, 0.50, 0.0},
                            {1.22, 0.62, 0.0},
                            {1.44, 0.98, 0.0},
                            {1.62, 1.32, 0.0},
                            {1.86, 1.46, 0.0}},
                           6);
  add_part(pot, tube(spout, between(0.25, 0.10, spout.size()), 24), glaze, glm::dmat4(1.0), 60.0);
  const auto handle = curve({{-0.80, 1.24, 0.0},
                             {-1.22, 1.34, 0.0},
                             {-1.62, 1.18, 0.0},
                             {-1.60, 0.76, 0.0},
                             {-1.28, 0.46, 0.0},
                             {-0.92, 0.40, 0.0}},
                            6);
  add_part(pot, tube(handle, std::vector<double>(handle.size(), 0.095), 20), glaze, glm::dmat4(1.0),
           60.0);
  b.place(b.add_mesh("teapot", std::move(pot)), turn_y(-24.0), "teapot");
  b.spot("lamp", {3.4, 5.2, 3.0}, {0.0, 0.6, 0.0}, {1.0f, 0.95f, 0.86f}, 1.2f, 32.0, disc(0.12))
      .inner_angle = 20.0;
  b.camera("main", {0.9, 3.1, 5.6}, {0.12, 0.62, 0.0}, 44.0);
  b.scene.ambient = glm::vec3(0.13f);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
