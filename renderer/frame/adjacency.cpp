#include "renderer/frame/adjacency.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <unordered_map>

#include "renderer/frame/components.h"
#include "renderer/frame/gpu_scene.h"

namespace penumbra {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// One side of a triangle: corner k to corner k + 1.
struct Side {
  std::uint64_t edge = 0;  ///< both corners, the smaller first
  std::uint32_t triangle = 0;
  std::uint8_t corner = 0;
  bool forward = false;  ///< runs from the smaller corner to the larger
};

struct Triangle {
  std::array<std::uint32_t, 3> corners{};
  glm::vec3 normal{0.0f};
  std::array<std::uint32_t, 3> opposite{none, none, none};  ///< across the side that starts there
  bool closed = true;
  bool degenerate = false;
};

struct PositionHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    for (int i = 0; i < 3; ++i) {
      hash ^= std::bit_cast<std::uint32_t>(p[i] + 0.0f);  // -0 is 0
      hash *= 0xff51afd7ed558ccdu;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// The triangles of one instance, their neighbourhoods and what they say of the mesh.
class InstanceAdjacency {
 public:
  InstanceAdjacency(std::span<const glm::vec3> positions, Adjacency& out)
      : positions_(positions), out_(out) {}

  void add(std::span<const std::uint32_t> indices) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = weld(indices[i + k]);
      const auto& c = triangle.corners;
      triangle.degenerate = c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
      const glm::dvec3 a(positions_[c[0]]);
      const glm::dvec3 normal =
          glm::cross(glm::dvec3(positions_[c[1]]) - a, glm::dvec3(positions_[c[2]]) - a);
      const double length = glm::length(normal);
      if (length > 0.0) triangle.normal = glm::vec3(normal / length);
      triangles_.push_back(triangle);
    }
  }

  void connect() {
    std::vector<Side> sides;
    sides.reserve(triangles_.size() * 3);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (triangles_[t].degenerate) {
        ++out_.degenerate_triangles;
        continue;
      }
      for (std::uint8_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles_[t].corners[k];
        const std::uint32_t b = triangles_[t].corners[(k + 1) % 3];
        sides.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), t, k, a < b});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.edge, a.triangle, a.corner) < std::tie(b.edge, b.triangle, b.corner);
    });
    Components components(triangles_.size());
    for (std::size_t first = 0; first < sides.size();) {
      std::size_t last = first;
      while (last < sides.size() && sides[last].edge == sides[first].edge) ++last;
      pair_up({sides.data() + first, last - first}, components);
      first = last;
    }
    // One open side leaves its whole component open.
    std::vector<bool> open(triangles_.size(), false);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (!triangles_[t].closed) open[components.root(t)] = true;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      triangles_[t].closed = !open[components.root(t)];
  }

  /// Appends the triangles that are closed, or those that are not, as one group.
  void write(bool closed, bool casts_shadow, std::uint32_t instance) {
    AdjacencyGroup group;
    group.first_index = static_cast<std::uint32_t>(out_.indices.size());
    group.instance = instance;
    group.closed = closed;
    group.casts_shadow = casts_shadow;
    group.low = glm::vec3(std::numeric_limits<float>::max());
    group.high = -group.low;
    for (const Triangle& triangle : triangles_) {
      if (triangle.closed != closed) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = triangle.corners[k];
        out_.indices.push_back(corner);
        out_.indices.push_back(triangle.opposite[k] == none ? corner : triangle.opposite[k]);
        group.low = glm::min(group.low, positions_[corner]);
        group.high = glm::max(group.high, positions_[corner]);
      }
    }
    group.index_count = static_cast<std::uint32_t>(out_.indices.size()) - group.first_index;
    if (group.index_count > 0) out_.groups.push_back(group);
  }

 private:
  std::uint32_t weld(std::uint32_t vertex) {
    return first_at_.try_emplace(positions_[vertex], vertex).first->second;
  }

  std::uint32_t opposite(const Side& side) const {
    return triangles_[side.triangle].corners[(side.corner + 2u) % 3];
  }

  /// Two triangles of the same corners, wound in opposite ways: a sheet modelled from both sides.
  /// Whatever it encloses, one of the two is lit where it is seen, and no volume of a closed body
  /// may end in a lit surface: each counts as a sheet of its own.
  void open_twins(const Side& a, const Side& b) {
    if (a.forward != b.forward && opposite(a) == opposite(b))
      triangles_[a.triangle].closed = triangles_[b.triangle].closed = false;
  }

  void couple(const Side& a, const Side& b, Components& components) {
    triangles_[a.triangle].opposite[a.corner] = opposite(b);
    triangles_[b.triangle].opposite[b.corner] = opposite(a);
    components.join(a.triangle, b.triangle);
    if (a.forward == b.forward)
      triangles_[a.triangle].closed = triangles_[b.triangle].closed = false;
  }

  void pair_up(std::span<const Side> sides, Components& components) {
    if (sides.size() == 2) {
      open_twins(sides[0], sides[1]);
      return couple(sides[0], sides[1], components);
    }
    if (sides.size() > 2) ++out_.non_manifold_edges;
    std::vector<bool> paired(sides.size(), false);
    struct Pair {
      std::size_t a, b;
      bool opposed;
      float likeness;  ///< cosine between the normals, as if wound alike
    };
    // All pairs are weighed; a hub of more triangles than any modeller draws is paired in order.
    constexpr std::size_t most_weighed = 64;
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const std::size_t end = std::min(sides.size(), i + most_weighed);
      for (std::size_t j = i + 1; j < end; ++j) {
        open_twins(sides[i], sides[j]);
        const bool opposed = sides[i].forward != sides[j].forward;
        const float cosine =
            glm::dot(triangles_[sides[i].triangle].normal, triangles_[sides[j].triangle].normal);
        pairs.push_back({i, j, opposed, opposed ? cosine : -cosine});
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
      return a.opposed != b.opposed ? a.opposed : a.likeness > b.likeness;
    });
    for (const Pair& pair : pairs) {
      if (paired[pair.a] || paired[pair.b]) continue;
      paired[pair.a] = paired[pair.b] = true;
      couple(sides[pair.a], sides[pair.b], components);
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (paired[i]) continue;
      triangles_[sides[i].triangle].closed = false;
      ++out_.open_edges;
    }
  }

  std::span<const glm::vec3> positions_;
  Adjacency& out_;
  std::vector<Triangle> triangles_;
  std::unordered_map<glm::vec3, std::uint32_t, PositionHash> first_at_;
};

}  // namespace

Adjacency build_adjacency(std::span<const glm::vec3> positions,
                          std::span<const std::uint32_t> indices,
                          std::span<const DrawRange> ranges) {
  Adjacency out;
  out.indices.reserve(indices.size() * 2);
  std::map<std::uint32_t, std::vector<const DrawRange*>> instances;
  for (const DrawRange& range : ranges) instances[range.instance].push_back(&range);
  std::map<std::uint32_t, InstanceAdjacency> built;
  for (const auto& [instance, parts] : instances) {
    InstanceAdjacency& mesh = built.try_emplace(instance, positions, out).first->second;
    for (const DrawRange* part : parts)
      mesh.add(indices.subspan(part->first_index, part->index_count));
    mesh.connect();
  }
  for (const bool closed : {true, false})
    for (const bool casts : {true, false})
      for (auto& [instance, mesh] : built)
        if (instances[instance].front()->casts_shadow == casts) mesh.write(closed, casts, instance);
  return out;
}

}  // namespace penumbra
