#include "renderer/shadow_volumes/hidden_casters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "renderer/scene/convex_clip.h"

namespace penumbra::shadow_volumes {
namespace {

/// How many casters are tried as what hides others, of how many triangles, and how many triangles
/// are looked at in all: some tenths of a second.
constexpr std::size_t most_tried = 64;
constexpr std::size_t most_triangles = 100000;
constexpr std::size_t most_looks = 10000000;

/// The way to the light: what lies between a point and the light is point + u (light - w point),
/// where u runs from 0 to `end`.
struct Way {
  glm::dvec4 light;  ///< homogeneous
  double end;        ///< 1 for a position
  glm::dvec3 from(const glm::dvec3& point) const { return glm::dvec3(light) - light.w * point; }
};

using Polygon = std::vector<glm::dvec3>;  ///< in a plane of two parameters, z zero

/// Keeps the parameters (s, t) at which low <= a + s b + t c <= high on every axis.
bool meets(Polygon domain, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
           const glm::dvec3& low, const glm::dvec3& high) {
  for (int axis = 0; axis < 3 && !domain.empty(); ++axis) {
    domain = clip(domain, {b[axis], c[axis], 0.0, a[axis] - low[axis]});
    domain = clip(domain, {-b[axis], -c[axis], 0.0, high[axis] - a[axis]});
  }
  return !domain.empty();
}

/// Whether an edge, or its shadow to infinity, touches the box: some point of the edge lies between
/// a point of the box and the light. With a light at a place, the point's offset from it is w times
/// that of a point of the box, 0 <= w <= 1; with a direction, the shadow is followed to `way.end`.
bool shadow_meets(const Way& way, const glm::dvec3& p, const glm::dvec3& q, const Bounds& box) {
  if (way.light.w == 0.0) {
    const Polygon domain{{0, 0, 0}, {1, 0, 0}, {1, way.end, 0}, {0, way.end, 0}};
    return meets(domain, p, q - p, -glm::dvec3(way.light), box.low, box.high);
  }
  const glm::dvec3 light(way.light);
  Polygon domain{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (int axis = 0; axis < 3 && !domain.empty(); ++axis) {
    const double a = p[axis] - light[axis];
    const double b = q[axis] - p[axis];
    domain = clip(domain, {b, -(box.low[axis] - light[axis]), 0.0, a});
    domain = clip(domain, {-b, box.high[axis] - light[axis], 0.0, -a});
  }
  return !domain.empty();
}

using Corners = std::array<glm::dvec3, 3>;

/// An instance as the light sees it.
struct Hider {
  std::vector<Corners> triangles;
  std::vector<std::array<glm::dvec3, 2>> borders;  ///< edges beyond which it may cover nothing
};

struct Caster {
  std::uint32_t instance = 0;
  Bounds box;
  std::size_t triangles = 0;
  double size_from_light = 0.0;  ///< of its box, squared, by the squared distance
};

std::vector<Caster> find_casters(const GpuScene& scene, const Way& way) {
  std::map<std::uint32_t, Caster> casters;
  for (const DrawRange& range : scene.ranges()) {
    if (!range.casts_shadow) continue;
    Caster& caster = casters[range.instance];
    caster.instance = range.instance;
    caster.box.add(glm::dvec3(range.low));
    caster.box.add(glm::dvec3(range.high));
    caster.triangles += range.index_count / 3;
  }
  std::vector<Caster> list;
  for (auto& [instance, caster] : casters) {
    const glm::dvec3 size = caster.box.size();
    const glm::dvec3 offset = way.light.w * (glm::dvec3(way.light) - caster.box.center());
    caster.size_from_light = glm::dot(size, size) /
                             (way.light.w == 0.0 ? 1.0 : std::max(glm::dot(offset, offset), 1e-30));
    list.push_back(caster);
  }
  return list;
}

/// Edges are borders unless two triangles share them that lie on either side as the light sees it.
Hider make_hider(const GpuScene& scene, const Way& way, std::uint32_t instance) {
  struct Less {
    bool operator()(const glm::vec3& a, const glm::vec3& b) const {
      return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }
  };
  struct Edge {
    glm::dvec3 p, q;
    std::vector<double> sides;
  };
  Hider hider;
  std::map<glm::vec3, std::uint32_t, Less> places;
  std::unordered_map<std::uint64_t, Edge> edges;
  for (const DrawRange& range : scene.ranges()) {
    if (range.instance != instance) continue;
    for (std::uint32_t i = 0; i + 2 < range.index_count; i += 3) {
      std::array<std::uint32_t, 3> place;
      Corners corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 at = scene.positions()[scene.indices()[range.first_index + i + k]];
        place[k] = places.try_emplace(at, static_cast<std::uint32_t>(places.size())).first->second;
        corners[k] = at;
      }
      if (place[0] == place[1] || place[1] == place[2] || place[2] == place[0]) continue;
      hider.triangles.push_back(corners);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = place[k] < place[(k + 1) % 3] ? k : (k + 1) % 3;
        const std::size_t b = a == k ? (k + 1) % 3 : k;
        Edge& edge = edges[std::uint64_t{place[a]} << 32 | place[b]];
        edge.p = corners[a];
        edge.q = corners[b];
        edge.sides.push_back(
            glm::dot(glm::cross(edge.q - edge.p, way.from(edge.p)), corners[(k + 2) % 3] - edge.p));
      }
    }
  }
  for (const auto& [key, edge] : edges)
    if (edge.sides.size() != 2 || edge.sides[0] * edge.sides[1] >= 0.0)
      hider.borders.push_back({edge.p, edge.q});
  return hider;
}

/// Whether the way from a point to the light meets a triangle.
bool is_hidden(const glm::dvec3& point, const Way& way, const Corners& t) {
  const glm::dvec3 along = way.from(point);
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double speed = glm::dot(normal, along);
  if (speed == 0.0) return false;
  const double at = glm::dot(normal, t[0] - point) / speed;
  if (at <= 0.0 || at >= way.end) return false;
  const double u = glm::dot(along, glm::cross(t[0] - point, t[1] - point));
  const double v = glm::dot(along, glm::cross(t[1] - point, t[2] - point));
  const double w = glm::dot(along, glm::cross(t[2] - point, t[0] - point));
  return std::min({u, v, w}) >= 0.0 || std::max({u, v, w}) <= 0.0;
}

/// Whether the way to the light from every corner of a box meets another box: from all points of it
/// otherwise not, and a look at triangles is spared.
bool may_hide(const Way& way, const Bounds& hider, const Bounds& box) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1) != 0 ? box.high.x : box.low.x,
                           (corner & 2) != 0 ? box.high.y : box.low.y,
                           (corner & 4) != 0 ? box.high.z : box.low.z);
    const glm::dvec3 along = way.from(point);
    double enter = 0.0, leave = way.end;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (hider.low[axis] - point[axis]) / along[axis];
      const double b = (hider.high[axis] - point[axis]) / along[axis];
      enter = std::fmax(enter, std::fmin(a, b));
      leave = std::fmin(leave, std::fmax(a, b));
    }
    if (enter > leave) return false;
  }
  return true;
}

/// Whether boxes of points and a box are apart.
template <std::size_t N>
bool are_apart(const std::array<glm::dvec3, N>& points, const Bounds& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto beyond = [&](const glm::dvec3& p) { return p[axis] > box.high[axis]; };
    const auto before = [&](const glm::dvec3& p) { return p[axis] < box.low[axis]; };
    if (std::all_of(points.begin(), points.end(), beyond) ||
        std::all_of(points.begin(), points.end(), before))
      return true;
  }
  return false;
}

/// Whether a point is in shadow can change within the box only where it meets a triangle, or the
/// shadow of a border: where none does, the middle tells of the whole.
bool hides(const Hider& hider, const Way& way, const Bounds& box) {
  const auto hides_middle = [&](const Corners& t) { return is_hidden(box.center(), way, t); };
  if (std::none_of(hider.triangles.begin(), hider.triangles.end(), hides_middle)) return false;
  const Polygon domain{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const Corners& t : hider.triangles)
    if (!are_apart(t, box) && meets(domain, t[0], t[1] - t[0], t[2] - t[0], box.low, box.high))
      return false;
  Bounds between = box;  // all points between box and light
  between.add(box.low + way.end * way.from(box.low));
  between.add(box.high + way.end * way.from(box.high));
  for (const auto& edge : hider.borders)
    if (!are_apart(edge, between) && shadow_meets(way, edge[0], edge[1], box)) return false;
  return true;
}

}  // namespace

std::set<std::uint32_t> find_hidden_casters(const GpuScene& scene, const WorldLight& light) {
  const double diagonal = static_cast<double>(glm::length(scene.high() - scene.low()));
  // To the light, or out of the scene where it is at infinity.
  const Way way{light.center, glm::mix(4.0 * diagonal, 1.0, light.center.w)};
  std::vector<Caster> casters = find_casters(scene, way);
  std::sort(casters.begin(), casters.end(), [](const Caster& a, const Caster& b) {
    return std::tie(b.size_from_light, a.instance) < std::tie(a.size_from_light, b.instance);
  });
  std::set<std::uint32_t> hidden;
  std::size_t tried = 0, looks = 0;
  for (const Caster& hider : casters) {
    if (tried == most_tried) break;
    std::vector<const Caster*> candidates;
    for (const Caster& caster : casters)
      if (caster.instance != hider.instance && !hidden.contains(caster.instance) &&
          may_hide(way, hider.box, caster.box))
        candidates.push_back(&caster);
    const std::size_t needed = hider.triangles * candidates.size();
    if (candidates.empty() || hider.triangles > most_triangles || looks + needed > most_looks)
      continue;
    ++tried;
    looks += needed;
    const Hider seen = make_hider(scene, way, hider.instance);
    for (const Caster* caster : candidates) {
      // Rounding of positions must not matter.
      Bounds box = caster->box;
      box.low -= 1e-5 * diagonal;
      box.high += 1e-5 * diagonal;
      if (hides(seen, way, box)) hidden.insert(caster->instance);
    }
  }
  return hidden;
}

}  // namespace penumbra::shadow_volumes
