#include <cmath>
#include <map>
#include <set>

#include "scenes/generators/noise.h"
#include "scenes/generators/random.h"
#include "scenes/generators/shapes.h"

namespace penumbra::scenes {

Solid plate(const std::vector<double>& xs, const std::vector<double>& ys,
            const std::vector<std::array<int, 2>>& holes, double thickness) {
  const int columns = static_cast<int>(xs.size()) - 1, rows = static_cast<int>(ys.size()) - 1;
  const std::set<std::array<int, 2>> open(holes.begin(), holes.end());
  const auto filled = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < columns && y < rows && open.count({x, y}) == 0;
  };
  Solid solid;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto point = [&](int x, int y, int front) {
    const auto [entry, added] =
        known.try_emplace({x, y, front}, static_cast<std::uint32_t>(solid.points.size()));
    if (added)
      solid.add_point({xs[static_cast<std::size_t>(x)], ys[static_cast<std::size_t>(y)],
                       (front - 0.5) * thickness});
    return entry->second;
  };
  // A wall from corner a to corner b of the grid, outside on the right of that way.
  const auto wall = [&](int ax, int ay, int bx, int by) {
    solid.add_quad(point(ax, ay, 0), point(bx, by, 0), point(bx, by, 1), point(ax, ay, 1));
  };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      if (!filled(x, y)) continue;
      solid.add_quad(point(x, y, 1), point(x + 1, y, 1), point(x + 1, y + 1, 1),
                     point(x, y + 1, 1));
      solid.add_quad(point(x, y, 0), point(x, y + 1, 0), point(x + 1, y + 1, 0),
                     point(x + 1, y, 0));
      if (!filled(x, y - 1)) wall(x, y, x + 1, y);
      if (!filled(x + 1, y)) wall(x + 1, y, x + 1, y + 1);
      if (!filled(x, y + 1)) wall(x + 1, y + 1, x, y + 1);
      if (!filled(x - 1, y)) wall(x, y + 1, x, y);
    }
  return solid;
}

Solid bar(const glm::dvec3& from, const glm::dvec3& to, double width, double height,
          const glm::dvec3& up) {
  const double length = glm::length(to - from);
  const glm::dvec3 along = (to - from) / length;
  const glm::dvec3 side = glm::normalize(glm::cross(up, along));
  const glm::dvec3 upward = glm::cross(along, side);
  const glm::dmat4 matrix(glm::dvec4(side, 0.0), glm::dvec4(upward, 0.0), glm::dvec4(along, 0.0),
                          glm::dvec4(from, 1.0));
  return transformed(box({-0.5 * width, -0.5 * height, 0.0}, {0.5 * width, 0.5 * height, length}),
                     matrix);
}

Solid boulder(std::uint32_t seed, double roughness, int slices, int stacks) {
  Solid solid = sphere(1.0, slices, stacks);
  const FractalNoise across(4, 4, 3, seed), along(4, 4, 3, seed + 9);
  for (glm::dvec3& p : solid.points) {
    // Two sheets of noise, crossed: no pole, no seam.
    const double bumps =
        across(0.5 + 0.31 * p.x, 0.5 + 0.31 * p.y) + along(0.5 + 0.31 * p.z, 0.5 + 0.31 * p.y);
    p *= 1.0 + roughness * (bumps - 1.0);
  }
  solid.uvs.clear();
  return solid;
}

Solid height_field(const glm::dvec2& low, const glm::dvec2& high, int columns,
                   const std::vector<double>& heights, double bottom) {
  Solid solid;
  const auto width = static_cast<std::uint32_t>(columns);
  const auto rows = static_cast<std::uint32_t>(heights.size()) / width;
  for (std::uint32_t z = 0; z < rows; ++z)
    for (std::uint32_t x = 0; x < width; ++x)
      solid.add_point({low.x + (high.x - low.x) * x / (width - 1), heights[z * width + x],
                       low.y + (high.y - low.y) * z / (rows - 1)});
  const auto top = [&](std::uint32_t x, std::uint32_t z) { return z * width + x; };
  for (std::uint32_t z = 0; z + 1 < rows; ++z)
    for (std::uint32_t x = 0; x + 1 < width; ++x)
      solid.add_quad(top(x, z), top(x, z + 1), top(x + 1, z + 1), top(x + 1, z));
  // The rim, counter-clockwise seen from above; the floor is a fan around one point in its middle.
  std::vector<std::uint32_t> rim, floor;
  for (std::uint32_t z = 0; z + 1 < rows; ++z) rim.push_back(top(0, z));
  for (std::uint32_t x = 0; x + 1 < width; ++x) rim.push_back(top(x, rows - 1));
  for (std::uint32_t z = rows - 1; z > 0; --z) rim.push_back(top(width - 1, z));
  for (std::uint32_t x = width - 1; x > 0; --x) rim.push_back(top(x, 0));
  for (const std::uint32_t point : rim) {
    glm::dvec3 below = solid.points[point];
    below.y = bottom;
    floor.push_back(solid.add_point(below));
  }
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const std::size_t next = (i + 1) % rim.size();
    solid.add_quad(floor[i], floor[next], rim[next], rim[i]);
  }
  const std::uint32_t middle =
      solid.add_point({0.5 * (low.x + high.x), bottom, 0.5 * (low.y + high.y)});
  for (std::size_t i = 0; i < floor.size(); ++i)
    solid.add_triangle(middle, floor[(i + 1) % floor.size()], floor[i]);
  return solid;
}

}  // namespace penumbra::scenes
