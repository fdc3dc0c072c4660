#include "renderer/frame/closed_bodies.h"

#include <algorithm>
#include <array>

#include "renderer/frame/components.h"

namespace penumbra {
namespace {

using Corners = std::array<std::uint32_t, 3>;

Corners corners_of(std::span<const std::uint32_t> corners, std::size_t first) {
  return {corners[first], corners[first + 1], corners[first + 2]};
}

/// Others cover nothing.
bool has_three_corners(const Corners& t) {
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

/// A side of a triangle, by the corner that it leaves.
struct SideTo {
  std::uint32_t end = 0;
  std::uint32_t triangle = 0;
  friend bool operator<(const SideTo& a, const SideTo& b) { return a.end < b.end; }
};

/// Sides of all triangles, found by their two ends.
class Sides {
 public:
  Sides(std::size_t places, std::span<const std::uint32_t> corners)
      : first_(places + 1), sides_(corners.size()) {
    const auto visit = [&](const auto& side) {
      for (std::uint32_t i = 0; i < corners.size(); i += 3)
        if (const Corners t = corners_of(corners, i); has_three_corners(t))
          for (std::size_t k = 0; k < 3; ++k) side(t[k], SideTo{t[(k + 1) % 3], i / 3});
    };
    visit([&](std::uint32_t from, const SideTo&) { ++first_[from + 1]; });
    for (std::size_t i = 0; i < places; ++i) first_[i + 1] += first_[i];
    std::vector<std::uint32_t> free(first_.begin(), first_.end() - 1);
    visit([&](std::uint32_t from, const SideTo& side) { sides_[free[from]++] = side; });
    for (std::size_t i = 0; i < places; ++i)
      std::sort(sides_.begin() + first_[i], sides_.begin() + first_[i + 1]);
  }

  /// All that run from a to b.
  std::span<const SideTo> between(std::uint32_t a, std::uint32_t b) const {
    const auto [begin, end] =
        std::equal_range(sides_.begin() + first_[a], sides_.begin() + first_[a + 1], SideTo{b, 0});
    return {begin, end};
  }

 private:
  std::vector<std::uint32_t> first_;  ///< by corner, where its sides begin
  std::vector<SideTo> sides_;         ///< sorted within each corner's
};

struct Body {
  bool open = false;
  double volume = 0.0;  ///< six times, below zero where it is wound inwards
};

}  // namespace

std::vector<bool> in_closed_bodies(std::span<const glm::vec3> positions,
                                   std::span<const std::uint32_t> corners) {
  const Sides sides(positions.size(), corners);
  const auto triangles = static_cast<std::uint32_t>(corners.size() / 3);
  std::vector<bool> open(triangles);
  Components components(triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Corners corner = corners_of(corners, 3 * t);
    if (!has_three_corners(corner)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corner[k], b = corner[(k + 1) % 3];
      const auto back = sides.between(b, a);
      if (back.size() == 1 && sides.between(a, b).size() == 1)
        components.join(t, back[0].triangle);
      else
        open[t] = true;
    }
  }
  std::vector<Body> bodies(triangles);  // by root
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const std::uint32_t root = components.root(t);
    const glm::dvec3 origin(positions[corners[3 * root]]);
    const auto place = [&](std::uint32_t k) {
      return glm::dvec3(positions[corners[3 * t + k]]) - origin;
    };
    bodies[root].volume += glm::dot(place(0), glm::cross(place(1), place(2)));
    bodies[root].open = bodies[root].open || open[t];
  }
  std::vector<bool> closed(triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Body& body = bodies[components.root(t)];
    closed[t] = !body.open && body.volume > 0.0;
  }
  return closed;
}

}  // namespace penumbra
