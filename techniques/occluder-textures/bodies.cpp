#include "techniques/occluder-textures/bodies.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "renderer/frame/components.h"

namespace penumbra::techniques::occluder_textures {
namespace {

struct Before {
  bool operator()(const glm::vec3& a, const glm::vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

OrientedBox box_along(const Body& body, const glm::dmat3& axes) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (const Triangle& triangle : body.triangles)
    for (const glm::dvec3& corner : triangle) {
      const glm::dvec3 at = glm::transpose(axes) * corner;
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  return {axes, axes * (0.5 * (low + high)), 0.5 * (high - low)};
}

/// Principal axes of a symmetric matrix by Jacobi's rotations.
glm::dmat3 principal_axes(glm::dmat3 m) {
  glm::dmat3 axes(1.0);
  for (int sweep = 0; sweep < 16; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (std::abs(m[q][p]) < 1e-15 * (std::abs(m[p][p]) + std::abs(m[q][q]))) continue;
        const double angle = 0.5 * std::atan2(2.0 * m[q][p], m[p][p] - m[q][q]);
        glm::dmat3 turn(1.0);
        turn[p][p] = turn[q][q] = std::cos(angle);
        turn[p][q] = std::sin(angle);
        turn[q][p] = -std::sin(angle);
        m = glm::transpose(turn) * m * turn;
        axes = axes * turn;
      }
  return axes;
}

double area_of(const Triangle& t) {
  return 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
}

glm::dmat3 principal_axes(const Body& body) {
  glm::dvec3 mean(0.0);
  double area = 0.0;
  for (const Triangle& t : body.triangles) {
    mean += area_of(t) * (t[0] + t[1] + t[2]) / 3.0;
    area += area_of(t);
  }
  if (area > 0.0) mean /= area;
  glm::dmat3 spread(0.0);
  // The integral of x x^T over a triangle, up to a factor.
  for (const Triangle& t : body.triangles) {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& corner : t) {
      spread += area_of(t) * glm::outerProduct(corner - mean, corner - mean);
      sum += corner - mean;
    }
    spread += area_of(t) * glm::outerProduct(sum, sum);
  }
  return principal_axes(spread);
}

/// Corners by position: equal ones have one number.
class Corners {
 public:
  std::size_t number(const glm::dvec3& corner) {
    return numbers_.try_emplace(glm::vec3(corner), numbers_.size()).first->second;
  }

 private:
  std::map<glm::vec3, std::size_t, Before> numbers_;
};

using NumberedTriangle = std::array<std::size_t, 3>;

std::vector<NumberedTriangle> numbered(const Body& body) {
  Corners corners;
  std::vector<NumberedTriangle> list;
  for (const Triangle& t : body.triangles)
    list.push_back({corners.number(t[0]), corners.number(t[1]), corners.number(t[2])});
  return list;
}

/// A body encloses space if its mean thickness is more than this part of its size.
constexpr double thinnest = 1e-5;

/// Whether every edge is run along as often one way as the other, no triangle lies on the back of
/// another, and there is something between: a sheet modelled from both sides encloses nothing.
bool encloses_space(const Body& body) {
  double volume = 0.0, area = 0.0;
  Bounds box;
  for (const Triangle& t : body.triangles) {
    const glm::dvec3 from = body.triangles[0][0];
    volume += glm::dot(t[0] - from, glm::cross(t[1] - from, t[2] - from)) / 6.0;
    area += area_of(t);
    for (const glm::dvec3& corner : t) box.add(corner);
  }
  if (std::abs(volume) <= thinnest * area * glm::length(box.size())) return false;
  std::map<std::pair<std::size_t, std::size_t>, int> runs;
  std::set<NumberedTriangle> known;
  for (const NumberedTriangle& t : numbered(body)) {
    NumberedTriangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    if (!known.insert(sorted).second) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = t[k], to = t[(k + 1) % 3];
      runs[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(runs.begin(), runs.end(), [](const auto& run) { return run.second == 0; });
}

/// A part may leave the plane of its largest triangle by this part of the body's size.
constexpr double bend = 0.01;

/// Parts of a sheet, each grown from the largest triangle left over the edges around it.
std::vector<Body> flat_parts(const Body& sheet) {
  const std::vector<NumberedTriangle> corners = numbered(sheet);
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> at_edge;
  Bounds box;
  for (std::size_t t = 0; t < corners.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      at_edge[std::minmax(corners[t][k], corners[t][(k + 1) % 3])].push_back(t);
      box.add(sheet.triangles[t][k]);
    }
  std::vector<std::size_t> largest_first(corners.size());
  std::iota(largest_first.begin(), largest_first.end(), std::size_t{0});
  std::stable_sort(largest_first.begin(), largest_first.end(), [&](std::size_t a, std::size_t b) {
    return area_of(sheet.triangles[a]) > area_of(sheet.triangles[b]);
  });
  std::vector<bool> taken(corners.size(), false);
  std::vector<Body> parts;
  for (const std::size_t seed : largest_first) {
    const Triangle& plane = sheet.triangles[seed];
    if (taken[seed] || area_of(plane) <= 0.0) continue;
    const glm::dvec3 normal = glm::normalize(glm::cross(plane[1] - plane[0], plane[2] - plane[0]));
    const auto is_near = [&](const Triangle& triangle) {
      return std::all_of(triangle.begin(), triangle.end(), [&](const glm::dvec3& corner) {
        return std::abs(glm::dot(normal, corner - plane[0])) <= bend * glm::length(box.size());
      });
    };
    Body part{sheet.instance, {}, true, 0};
    std::vector<std::size_t> front{seed};
    taken[seed] = true;
    while (!front.empty()) {
      const std::size_t t = front.back();
      front.pop_back();
      part.triangles.push_back(sheet.triangles[t]);
      for (std::size_t k = 0; k < 3; ++k)
        for (const std::size_t next :
             at_edge[std::minmax(corners[t][k], corners[t][(k + 1) % 3])]) {
          if (taken[next] || !is_near(sheet.triangles[next])) continue;
          taken[next] = true;
          front.push_back(next);
        }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

double thinness(const OrientedBox& box) {
  return std::min({box.half.x, box.half.y, box.half.z});
}

}  // namespace

std::vector<Body> find_bodies(const GpuScene& scene, const std::set<std::uint32_t>& instances) {
  std::map<std::uint32_t, std::vector<std::array<std::uint32_t, 3>>> casters;
  for (const DrawRange& range : scene.ranges()) {
    if (!range.casts_shadow || !instances.contains(range.instance)) continue;
    for (std::uint32_t i = 0; i < range.index_count; i += 3) {
      const std::uint32_t* corner = &scene.indices()[range.first_index + i];
      casters[range.instance].push_back({corner[0], corner[1], corner[2]});
    }
  }
  std::vector<Body> bodies;
  for (const auto& [instance, triangles] : casters) {
    std::map<glm::vec3, std::uint32_t, Before> first_at;  // the first triangle with this corner
    Components sets(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (const std::uint32_t corner : triangles[t])
        sets.join(first_at.try_emplace(scene.positions()[corner], t).first->second, t);
    std::map<std::uint32_t, std::size_t> place;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const auto [entry, fresh] = place.try_emplace(sets.root(t), bodies.size());
      if (fresh) bodies.push_back({instance, {}, false, 0});
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k)
        triangle[k] = glm::dvec3(scene.positions()[triangles[t][k]]);
      bodies[entry->second].triangles.push_back(triangle);
    }
  }
  return bodies;
}

FlatParts in_flat_parts(std::vector<Body> bodies, std::size_t most) {
  FlatParts result;
  std::uint32_t whole = 0;
  for (Body& body : bodies) {
    std::vector<Body> parts;
    if (!encloses_space(body)) {
      parts = flat_parts(body);
      if (parts.size() > most) {
        ++result.open;
        parts.clear();
      }
    }
    if (parts.empty()) parts.push_back(std::move(body));
    for (Body& part : parts) {
      part.whole = whole;
      result.bodies.push_back(std::move(part));
    }
    ++whole;
  }
  return result;
}

OrientedBox box_around(const Body& body, const glm::dmat3& axes) {
  const OrientedBox given = box_along(body, axes);
  const OrientedBox principal = box_along(body, principal_axes(body));
  return thinness(principal) < 0.98 * thinness(given) ? principal : given;
}

}  // namespace penumbra::techniques::occluder_textures
