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

/// Not with two equal corners.
bool covers_anything(const Corners& t) {
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

/// Sides of triangles by the corner that they leave.
class Sides {
 public:
  Sides(std::size_t places, std::span<const std::uint32_t> corners)
      : first_(places + 1), ends_(corners.size()) {
    const auto visit = [&](const auto& side) {
      for (std::size_t i = 0; i < corners.size(); i += 3)
        if (const Corners t = corners_of(corners, i); covers_anything(t))
          for (std::size_t k = 0; k < 3; ++k) side(t[k], t[(k + 1) % 3]);
    };
    visit([&](std::uint32_t from, std::uint32_t) { ++first_[from + 1]; });
    for (std::size_t i = 0; i < places; ++i) first_[i + 1] += first_[i];
    std::vector<std::uint32_t> free(first_.begin(), first_.end() - 1);
    visit([&](std::uint32_t from, std::uint32_t to) { ends_[free[from]++] = to; });
    for (std::size_t i = 0; i < places; ++i)
      std::sort(ends_.begin() + first_[i], ends_.begin() + first_[i + 1]);
  }

  /// How many run from a to b.
  std::ptrdiff_t count(std::uint32_t a, std::uint32_t b) const {
    const auto [begin, end] =
        std::equal_range(ends_.begin() + first_[a], ends_.begin() + first_[a + 1], b);
    return end - begin;
  }

 private:
  std::vector<std::uint32_t> first_;  ///< by corner, where its sides begin
  std::vector<std::uint32_t> ends_;   ///< sorted within each corner's
};

struct Body {
  bool open = false;
  double volume = 0.0;  ///< six times, below zero where it is wound inwards
};

}  // namespace

std::vector<bool> in_closed_bodies(std::span<const glm::vec3> positions,
                                   std::span<const std::uint32_t> corners) {
  const Sides sides(positions.size(), corners);
  Components components(positions.size());
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    components.join(corners[i], corners[i + 1]);
    components.join(corners[i], corners[i + 2]);
  }
  std::vector<Body> bodies(positions.size());  // by root
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const Corners t = corners_of(corners, i);
    if (!covers_anything(t)) continue;
    const std::uint32_t root = components.root(t[0]);
    Body& body = bodies[root];
    const auto place = [&](int k) {
      return glm::dvec3(positions[t[k]]) - glm::dvec3(positions[root]);
    };
    body.volume += glm::dot(place(0), glm::cross(place(1), place(2)));
    for (std::size_t k = 0; k < 3 && !body.open; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      body.open = sides.count(a, b) != 1 || sides.count(b, a) != 1;
    }
  }
  std::vector<bool> closed(corners.size() / 3);
  for (std::size_t t = 0; t < closed.size(); ++t) {
    const Body& body = bodies[components.root(corners[3 * t])];
    closed[t] = !body.open && body.volume > 0.0;
  }
  return closed;
}

}  // namespace penumbra
