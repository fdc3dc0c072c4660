#include "scenes/generators/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

using Ring = std::vector<std::uint32_t>;

/// Joins two rings of equal size; `upper` lies where the rings go to.
void join(Solid& solid, const Ring& lower, const Ring& upper) {
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const std::size_t next = (i + 1) % lower.size();
    solid.add_quad(lower[i], lower[next], upper[next], upper[i]);
  }
}

/// Closes a ring with triangles around its first corner pair: for convex rings.
void close_convex(Solid& solid, const Ring& ring, bool reversed) {
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    if (reversed)
      solid.add_triangle(ring[0], ring[i + 1], ring[i]);
    else
      solid.add_triangle(ring[0], ring[i], ring[i + 1]);
}

Ring circle_ring(Solid& solid, double radius, double height, int slices) {
  Ring ring;
  for (int i = 0; i < slices; ++i) {
    // Angle runs from z to x, which is counter-clockwise seen from above.
    const glm::dvec2 c = circle(360.0 * i / slices);
    ring.push_back(solid.add_point({radius * c.y, height, radius * c.x}));
  }
  return ring;
}

std::vector<glm::dvec2> profile_lengths(const std::vector<glm::dvec2>& profile, double* widest) {
  std::vector<glm::dvec2> lengths;
  double sum = 0.0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (i > 0) sum += glm::length(profile[i] - profile[i - 1]);
    lengths.emplace_back(0.0, -sum);
    *widest = std::max(*widest, profile[i].x);
  }
  return lengths;
}

}  // namespace

Solid box(const glm::dvec3& low, const glm::dvec3& high) {
  Solid solid;
  for (int i = 0; i < 8; ++i)
    solid.add_point({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  solid.add_quad(0, 4, 6, 2);
  solid.add_quad(1, 3, 7, 5);
  solid.add_quad(0, 1, 5, 4);
  solid.add_quad(2, 6, 7, 3);
  solid.add_quad(0, 2, 3, 1);
  solid.add_quad(4, 5, 7, 6);
  return solid;
}

Solid rounded_box(const glm::dvec3& low, const glm::dvec3& high, double radius, int segments) {
  const int last = 2 * segments + 1;
  const glm::dvec3 center = 0.5 * (low + high);
  const glm::dvec3 core = 0.5 * (high - low) - radius;
  // Slope of the direction at line i of a face: tan of -45..0..45 degrees, twice 0 in the middle.
  const auto slope = [&](int i) {
    const double step = i <= segments ? i - segments : i - segments - 1;
    const glm::dvec2 c = circle(45.0 * step / segments);
    return c.y / c.x;
  };
  Solid solid;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto point = [&](const std::array<int, 3>& index) {
    const auto [entry, added] =
        known.try_emplace(index, static_cast<std::uint32_t>(solid.points.size()));
    if (added) {
      const glm::dvec3 direction(slope(index[0]), slope(index[1]), slope(index[2]));
      glm::dvec3 corner = core;
      for (int k = 0; k < 3; ++k)
        if (index[static_cast<std::size_t>(k)] <= segments) corner[k] = -core[k];
      solid.add_point(center + corner + radius * glm::normalize(direction));
    }
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, last})
      for (int i = 0; i < last; ++i)
        for (int j = 0; j < last; ++j) {
          const auto corner = [&](int a, int b) {
            std::array<int, 3> index{};
            index[axis] = side;
            index[(axis + 1) % 3] = a;
            index[(axis + 2) % 3] = b;
            return point(index);
          };
          if (side == 0)
            solid.add_quad(corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j));
          else
            solid.add_quad(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
  return solid;
}

Solid lathe(const std::vector<glm::dvec2>& profile, int slices) {
  Solid solid;
  double widest = 0.0;
  const std::vector<glm::dvec2> along = profile_lengths(profile, &widest);
  const double around = 2.0 * 3.141592653589793 * widest;
  const auto uv = [&](std::size_t row, double slice) {
    return glm::dvec2(around * slice / slices, along[row].y);
  };
  std::vector<Ring> rings;
  for (const glm::dvec2& p : profile)
    rings.push_back(p.x > 0.0 ? circle_ring(solid, p.x, p.y, slices)
                              : Ring{solid.add_point({0.0, p.y, 0.0})});
  for (std::size_t row = 0; row + 1 < rings.size(); ++row)
    for (int i = 0; i < slices; ++i) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>((i + 1) % slices);
      const bool lower_point = rings[row].size() == 1, upper_point = rings[row + 1].size() == 1;
      const auto lower = [&](std::size_t k) { return rings[row][lower_point ? 0 : k]; };
      const auto upper = [&](std::size_t k) { return rings[row + 1][upper_point ? 0 : k]; };
      if (!lower_point) {
        solid.add_triangle(lower(a), lower(b), upper(b));
        solid.uvs.push_back({uv(row, i), uv(row, i + 1), uv(row + 1, i + 1)});
      }
      if (!upper_point) {
        solid.add_triangle(lower(a), upper(b), upper(a));
        solid.uvs.push_back({uv(row, i), uv(row + 1, i + 1), uv(row + 1, i)});
      }
    }
  const std::size_t skin = solid.triangles.size();
  if (rings.front().size() > 1) close_convex(solid, rings.front(), true);
  if (rings.back().size() > 1) close_convex(solid, rings.back(), false);
  for (std::size_t t = skin; t < solid.triangles.size(); ++t) {
    std::array<glm::dvec2, 3> flat;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3& p = solid.points[solid.triangles[t][k]];
      flat[k] = {p.x, p.z};
    }
    solid.uvs.push_back(flat);
  }
  return solid;
}

Solid ring(const std::vector<glm::dvec2>& loop, int slices) {
  Solid solid;
  std::vector<Ring> rings;
  for (const glm::dvec2& p : loop) rings.push_back(circle_ring(solid, p.x, p.y, slices));
  for (std::size_t i = 0; i < rings.size(); ++i)
    join(solid, rings[i], rings[(i + 1) % rings.size()]);
  return solid;
}

Solid sphere(double radius, int slices, int stacks) {
  std::vector<glm::dvec2> profile;
  for (int i = 0; i <= stacks; ++i) {
    const glm::dvec2 c = circle(180.0 * i / stacks);
    profile.emplace_back(i == 0 || i == stacks ? 0.0 : radius * c.y, -radius * c.x);
  }
  return lathe(profile, slices);
}

Solid cylinder(double radius_low, double radius_high, double height, int slices) {
  return lathe({{radius_low, 0.0}, {radius_high, height}}, slices);
}

Solid torus(double radius, double tube_radius, int slices, int sides) {
  std::vector<glm::dvec2> loop;
  for (int i = 0; i < sides; ++i) {
    const glm::dvec2 c = circle(360.0 * i / sides);
    loop.emplace_back(radius + tube_radius * c.x, tube_radius * c.y);
  }
  return ring(loop, slices);
}

Solid trefoil(double tube_radius, int steps, int sides) {
  Solid solid;
  std::vector<Ring> rings;
  for (int i = 0; i < steps; ++i) {
    const double t = 360.0 * i / steps;
    const glm::dvec2 c1 = circle(t), c2 = circle(2.0 * t), c3 = circle(3.0 * t);
    const double size = 0.155;  // the curve reaches 3 units from its centre
    const glm::dvec3 center = size * glm::dvec3(c1.y + 2.0 * c2.y, c1.x - 2.0 * c2.x, -c3.y);
    const glm::dvec3 along =
        glm::normalize(glm::dvec3(c1.x + 4.0 * c2.x, -c1.y + 4.0 * c2.y, -3.0 * c3.x));
    const glm::dvec3 side = glm::normalize(glm::cross(along, glm::dvec3(0, 0, 1)));
    const glm::dvec3 up = glm::cross(side, along);
    Ring ring;
    for (int k = 0; k < sides; ++k) {
      const glm::dvec2 c = circle(360.0 * k / sides);
      ring.push_back(solid.add_point(center + tube_radius * (c.x * side + c.y * up)));
    }
    rings.push_back(ring);
  }
  // Seen against the way of the curve (side, up, -along is right-handed), so rings run backwards.
  for (std::size_t i = 0; i < rings.size(); ++i)
    join(solid, rings[(i + 1) % rings.size()], rings[i]);
  return solid;
}

Solid tube(const std::vector<glm::dvec3>& path, const std::vector<double>& radii, int sides) {
  std::vector<std::vector<glm::dvec3>> rings;
  // A frame carried along the path turns no more than the path does.
  glm::dvec3 side(0.0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const glm::dvec3 along =
        glm::normalize(path[std::min(i + 1, path.size() - 1)] - path[i == 0 ? 0 : i - 1]);
    const glm::dvec3 start = std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 guess = i == 0 ? start : side;
    side = glm::normalize(guess - glm::dot(guess, along) * along);
    const glm::dvec3 up = glm::cross(along, side);
    std::vector<glm::dvec3> ring;
    for (int k = 0; k < sides; ++k) {
      const glm::dvec2 c = circle(360.0 * k / sides);
      ring.push_back(path[i] + radii[i] * (c.x * side + c.y * up));
    }
    rings.push_back(ring);
  }
  return loft(rings);
}

Solid extrude(const std::vector<glm::dvec2>& polygon, double depth) {
  std::vector<std::vector<glm::dvec3>> rings(2);
  for (const glm::dvec2& p : polygon) {
    rings[0].emplace_back(p, -0.5 * depth);
    rings[1].emplace_back(p, 0.5 * depth);
  }
  return loft(rings);
}

Solid loft(const std::vector<std::vector<glm::dvec3>>& rings) {
  Solid solid;
  std::vector<Ring> indices;
  for (const auto& ring : rings) {
    Ring row;
    for (const glm::dvec3& point : ring) row.push_back(solid.add_point(point));
    indices.push_back(row);
  }
  for (std::size_t i = 0; i + 1 < indices.size(); ++i) join(solid, indices[i], indices[i + 1]);
  // Newell's normal of an end, which holds for concave and slightly bent ends too.
  const auto newell = [](const std::vector<glm::dvec3>& ring) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < ring.size(); ++i)
      sum += glm::cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
    return sum;
  };
  solid.add_polygon(indices.back(), newell(rings.back()));
  solid.add_polygon(Ring(indices.front().rbegin(), indices.front().rend()), -newell(rings.front()));
  return solid;
}

}  // namespace penumbra::scenes
