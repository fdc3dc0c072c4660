#include "renderer/shadow_volumes/crowding.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <tuple>

namespace penumbra::shadow_volumes {
namespace {

/// Cells are halved along both axes at most so often: to 0.005 degrees of a point light.
constexpr int most_halvings = 14;
/// Tests of a triangle against a cell before the search gives up: half a second.
constexpr std::size_t most_tests = 20'000'000;
/// Sine of the angle to the light below which rounding decides which way a triangle looks.
constexpr double edge_on = 1e-6;

/// A triangle as the light sees it: directions (x, y, z) of a point light with z along the axis of
/// a face, or places (x, y, 1) across a directional light's way.
struct Seen {
  std::array<glm::dvec3, 3> corners;
  std::array<glm::dvec3, 3> edges;  ///< planes through the light, inside positive; zero if edge-on
};

/// Directions whose x / z and y / z lie within.
struct Cell {
  glm::dvec2 low, high;
};

Seen seen(const std::array<glm::dvec3, 3>& corners, bool flat) {
  Seen result{corners, {}};
  if (flat) return result;
  const double side = glm::dot(corners[0], glm::cross(corners[1], corners[2])) < 0.0 ? -1.0 : 1.0;
  for (std::size_t k = 0; k < 3; ++k)
    result.edges[k] = side * glm::cross(corners[k], corners[(k + 1) % 3]);
  return result;
}

/// False only where no direction of the cell meets the triangle.
bool may_meet(const Seen& triangle, const Cell& cell) {
  const auto all = [&](const auto& outside) {
    return outside(triangle.corners[0]) && outside(triangle.corners[1]) &&
           outside(triangle.corners[2]);
  };
  if (all([](const glm::dvec3& c) { return c.z <= 0.0; }) ||
      all([&](const glm::dvec3& c) { return c.x < cell.low.x * c.z; }) ||
      all([&](const glm::dvec3& c) { return c.x > cell.high.x * c.z; }) ||
      all([&](const glm::dvec3& c) { return c.y < cell.low.y * c.z; }) ||
      all([&](const glm::dvec3& c) { return c.y > cell.high.y * c.z; }))
    return false;
  for (const glm::dvec3& edge : triangle.edges) {
    const glm::dvec3 farthest(edge.x > 0.0 ? cell.high.x : cell.low.x,
                              edge.y > 0.0 ? cell.high.y : cell.low.y, 1.0);
    if (glm::dot(edge, farthest) < 0.0) return false;
  }
  return true;
}

bool contains(const Seen& triangle, const glm::dvec2& place) {
  return std::all_of(triangle.edges.begin(), triangle.edges.end(), [&](const glm::dvec3& edge) {
    return glm::dot(edge, glm::dvec3(place, 1.0)) > 0.0;
  });
}

/// Counts of triangles over a grid of equal cells, each triangle in all cells that its box touches.
/// No direction meets more triangles than the fullest cell holds. Takes a few operations a
/// triangle, where a search takes thousands.
class BoxCounts {
 public:
  explicit BoxCounts(const Cell& root)
      : root_(root),
        scale_(double{side} / glm::max(root.high - root.low, 1e-290)),
        steps_((side + 1) * (side + 1)) {}

  void add(const std::array<glm::dvec3, 3>& triangle) {
    glm::dvec2 low(1e300), high(-1e300);
    for (const glm::dvec3& corner : triangle) {
      if (corner.z > 0.0) {
        low = glm::min(low, glm::dvec2(corner) / corner.z);
        high = glm::max(high, glm::dvec2(corner) / corner.z);
        continue;
      }
      // Part of it lies behind the light: it may be seen anywhere.
      low = glm::dvec2(-1e300);
      high = glm::dvec2(1e300);
      break;
    }
    const glm::dvec2 first = (low - root_.low) * scale_ - rounding;
    const glm::dvec2 last = (high - root_.low) * scale_ + rounding;
    if (last.x < 0.0 || last.y < 0.0 || first.x > side || first.y > side) return;
    const glm::ivec2 begin(glm::clamp(first, 0.0, side - 1.0));
    const glm::ivec2 end = glm::ivec2(glm::clamp(last, 0.0, side - 1.0)) + 1;
    ++step(begin.x, begin.y);
    --step(end.x, begin.y);
    --step(begin.x, end.y);
    ++step(end.x, end.y);
  }

  /// Triangles in the fullest cell. Once only: steps become sums.
  std::size_t most() {
    std::int32_t largest = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        if (x > 0) step(x, y) += step(x - 1, y);
        if (y > 0) step(x, y) += step(x, y - 1);
        if (x > 0 && y > 0) step(x, y) -= step(x - 1, y - 1);
        largest = std::max(largest, step(x, y));
      }
    return static_cast<std::size_t>(largest);
  }

 private:
  static constexpr int side = 512;
  static constexpr double rounding = 1e-6;  ///< cells; a triangle on a border is in both

  std::int32_t& step(int x, int y) { return steps_[static_cast<std::size_t>(y * (side + 1) + x)]; }

  Cell root_;
  glm::dvec2 scale_;
  std::vector<std::int32_t> steps_;  ///< changes of the count along both axes
};

/// What is said where the search cannot tell.
enum class Doubt { crowded, empty };

class Search {
 public:
  Search(std::vector<Seen> triangles, std::size_t most, Doubt doubt)
      : triangles_(std::move(triangles)), most_(most), doubt_(doubt) {}

  bool crowded(const Cell& root) {
    std::vector<std::uint32_t> all(triangles_.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    return crowded(root, all, 0);
  }

 private:
  bool crowded(const Cell& cell, const std::vector<std::uint32_t>& candidates, int halvings) {
    if (candidates.size() <= most_) return false;
    tests_ += candidates.size();
    if (tests_ > most_tests) return doubt_ == Doubt::crowded;
    std::vector<std::uint32_t> within;
    for (const std::uint32_t index : candidates)
      if (may_meet(triangles_[index], cell)) within.push_back(index);
    if (within.size() <= most_) return false;
    const glm::dvec2 middle = 0.5 * (cell.low + cell.high);
    if (halvings == most_halvings) {
      if (doubt_ == Doubt::crowded) return true;
      const auto met = std::count_if(within.begin(), within.end(), [&](std::uint32_t index) {
        return contains(triangles_[index], middle);
      });
      return static_cast<std::size_t>(met) > most_;
    }
    for (int part = 0; part < 4; ++part) {
      Cell quarter = cell;
      ((part & 1) != 0 ? quarter.low : quarter.high).x = middle.x;
      ((part & 2) != 0 ? quarter.low : quarter.high).y = middle.y;
      if (crowded(quarter, within, halvings + 1)) return true;
    }
    return false;
  }

  std::vector<Seen> triangles_;
  std::size_t most_;
  Doubt doubt_;
  std::size_t tests_ = 0;
};

/// Corners of a triangle that throws a volume, seen from the light (from the origin when
/// directional).
struct Thrower {
  std::array<glm::dvec3, 3> corners;
  bool flat;  ///< edge-on
};

std::vector<Thrower> find_throwers(const GpuScene& scene, const WorldLight& light,
                                   const VolumeTriangles& wanted) {
  std::vector<Thrower> throwers;
  for (const DrawRange& range : scene.ranges()) {
    if (!range.casts_shadow) continue;
    const bool every = wanted.sheets.contains(range.instance);
    for (std::uint32_t i = 0; i + 2 < range.index_count; i += 3) {
      Thrower thrower{};
      const auto position = [&](std::uint32_t k) {
        return glm::dvec3(scene.positions()[scene.indices()[range.first_index + i + k]]);
      };
      for (std::uint32_t k = 0; k < 3; ++k) thrower.corners[k] = position(k) - light.origin();
      const auto& [a, b, c] = thrower.corners;
      const glm::dvec3 to_light = light.to_center(position(0));
      const glm::dvec3 normal = glm::cross(b - a, c - a);
      const double height = glm::dot(normal, to_light);
      const double doubt = edge_on * glm::length(normal) * glm::length(to_light);
      if (!every && (wanted.lit ? height < -doubt : height > doubt)) continue;
      thrower.flat = std::abs(height) <= doubt;
      throwers.push_back(thrower);
    }
  }
  return throwers;
}

/// The triangles with `forward` along z, and the cell that holds all of that side.
bool crowded_along(const std::vector<Thrower>& throwers, const WorldLight& light,
                   const glm::dvec3& forward, std::size_t most, Doubt doubt) {
  const bool parallel = is_at_infinity(*light.source);
  const glm::dvec3 right =
      glm::normalize(std::abs(forward.y) < 0.9 ? glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0))
                                               : glm::cross(forward, glm::dvec3(1.0, 0.0, 0.0)));
  const glm::dvec3 up = glm::cross(right, forward);
  Cell root{glm::dvec2(-1.0), glm::dvec2(1.0)};
  if (parallel) root = {glm::dvec2(1e300), glm::dvec2(-1e300)};
  std::vector<std::array<glm::dvec3, 3>> triangles;
  triangles.reserve(throwers.size());
  for (const Thrower& thrower : throwers) {
    std::array<glm::dvec3, 3>& corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3& corner = thrower.corners[k];
      corners[k] = {glm::dot(right, corner), glm::dot(up, corner),
                    parallel ? 1.0 : glm::dot(forward, corner)};
      if (!parallel) continue;
      root.low = glm::min(root.low, glm::dvec2(corners[k]));
      root.high = glm::max(root.high, glm::dvec2(corners[k]));
    }
  }
  BoxCounts boxes(root);
  for (const auto& triangle : triangles) boxes.add(triangle);
  if (boxes.most() <= most) return false;
  std::vector<Seen> all;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    all.push_back(seen(triangles[i], throwers[i].flat));
  return Search(std::move(all), most, doubt).crowded(root);
}

bool search(const GpuScene& scene, const WorldLight& light, const VolumeTriangles& triangles,
            std::size_t most, Doubt doubt) {
  const std::vector<Thrower> throwers = find_throwers(scene, light, triangles);
  if (throwers.size() <= most) return false;
  if (is_at_infinity(*light.source))
    return crowded_along(throwers, light, light.direction, most, doubt);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      glm::dvec3 forward(0.0);
      forward[axis] = side;
      if (crowded_along(throwers, light, forward, most, doubt)) return true;
    }
  return false;
}

/// What was found for a scene: the same for all techniques and pictures of it.
struct Found {
  using Asked =
      std::tuple<std::array<double, 7>, bool, std::set<std::uint32_t>, std::size_t, Doubt>;
  mutable std::map<Asked, bool> answers;
};

bool crowded(const GpuScene& scene, const WorldLight& light, const VolumeTriangles& triangles,
             std::size_t most, Doubt doubt) {
  auto& answers = scene.derived<Found>([] { return std::make_shared<const Found>(); }).answers;
  const glm::dvec4& at = light.center;
  const glm::dvec3& along = light.direction;
  const Found::Asked asked{{at.x, at.y, at.z, at.w, along.x, along.y, along.z},
                           triangles.lit,
                           triangles.sheets,
                           most,
                           doubt};
  const auto known = answers.find(asked);
  if (known != answers.end()) return known->second;
  return answers[asked] = search(scene, light, triangles, most, doubt);
}

}  // namespace

bool may_crowd(const GpuScene& scene, const WorldLight& light, const VolumeTriangles& triangles,
               std::size_t most) {
  return crowded(scene, light, triangles, most, Doubt::crowded);
}

bool surely_crowds(const GpuScene& scene, const WorldLight& light, const VolumeTriangles& triangles,
                   std::size_t most) {
  return crowded(scene, light, triangles, most, Doubt::empty);
}

}  // namespace penumbra::shadow_volumes
