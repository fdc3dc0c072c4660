#include <cmath>
#include <cstring>
#include <unordered_map>

#include "scenes/generators/random.h"
#include "scenes/generators/solid.h"

namespace penumbra::scenes {
namespace {

struct PositionHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::uint32_t words[3];
    const glm::vec3 same_zero = p + 0.0f;  // -0 is the same place as 0
    std::memcpy(words, &same_zero, sizeof words);
    std::uint64_t h = words[0];
    for (int i = 1; i < 3; ++i) h = (h ^ (h >> 29)) * 0x9E3779B97F4A7C15ull + words[i];
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

/// Number of the place each vertex is at; vertices at equal positions get equal numbers.
std::vector<std::uint32_t> places_of(const Mesh& mesh) {
  std::unordered_map<glm::vec3, std::uint32_t, PositionHash> known;
  known.reserve(mesh.positions.size());
  std::vector<std::uint32_t> places;
  places.reserve(mesh.positions.size());
  for (const glm::vec3& position : mesh.positions)
    places.push_back(
        known.try_emplace(position, static_cast<std::uint32_t>(known.size())).first->second);
  return places;
}

/// Unit vector, or up where there is no direction.
glm::vec3 unit(const glm::dvec3& vector) {
  const double length = glm::length(vector);
  return std::isfinite(length) && length > 0.0 ? glm::vec3(vector / length) : glm::vec3(0, 1, 0);
}

/// Corners grouped by place: those of place p are corners[first[p]] .. corners[first[p + 1]].
struct CornersByPlace {
  std::vector<std::uint32_t> first, corners;
};

CornersByPlace group_corners(const Mesh& mesh, const std::vector<std::uint32_t>& places) {
  std::uint32_t count = 0;
  for (const std::uint32_t place : places) count = std::max(count, place + 1);
  CornersByPlace groups;
  groups.first.assign(count + 1, 0);
  for (const std::uint32_t vertex : mesh.indices) ++groups.first[places[vertex] + 1];
  for (std::uint32_t p = 0; p < count; ++p) groups.first[p + 1] += groups.first[p];
  groups.corners.resize(mesh.indices.size());
  std::vector<std::uint32_t> next = groups.first;
  for (std::uint32_t c = 0; c < mesh.indices.size(); ++c)
    groups.corners[next[places[mesh.indices[c]]]++] = c;
  return groups;
}

}  // namespace

void compute_normals(Mesh& mesh, double crease) {
  std::vector<glm::dvec3> faces;
  faces.reserve(mesh.indices.size() / 3);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.positions[mesh.indices[i]]);
    faces.push_back(glm::cross(glm::dvec3(mesh.positions[mesh.indices[i + 1]]) - a,
                               glm::dvec3(mesh.positions[mesh.indices[i + 2]]) - a));
  }
  const std::vector<std::uint32_t> places = places_of(mesh);
  const CornersByPlace groups = group_corners(mesh, places);
  const double least_cosine = circle(crease).x;
  const auto corner_normal = [&](std::uint32_t corner) {
    const glm::dvec3& own = faces[corner / 3];
    if (crease <= 0.0) return unit(own);
    const double own_length = glm::length(own);
    glm::dvec3 sum = own;
    const std::uint32_t place = places[mesh.indices[corner]];
    for (std::uint32_t k = groups.first[place]; k < groups.first[place + 1]; ++k) {
      const glm::dvec3& other = faces[groups.corners[k] / 3];
      if (groups.corners[k] / 3 != corner / 3 &&
          glm::dot(own, other) >= least_cosine * own_length * glm::length(other))
        sum += other;
    }
    return unit(sum);
  };

  // Each vertex is split into a chain of copies, one per different normal.
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> head(mesh.positions.size(), none), next;
  Mesh split;
  for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner) {
    const std::uint32_t vertex = mesh.indices[corner];
    const glm::vec3 normal = corner_normal(corner);
    std::uint32_t copy = head[vertex];
    while (copy != none && glm::dot(split.normals[copy], normal) < 0.999999f) copy = next[copy];
    if (copy == none) {
      copy = static_cast<std::uint32_t>(split.positions.size());
      split.positions.push_back(mesh.positions[vertex]);
      split.normals.push_back(normal);
      if (!mesh.uvs.empty()) split.uvs.push_back(mesh.uvs[vertex]);
      if (!mesh.colors.empty()) split.colors.push_back(mesh.colors[vertex]);
      next.push_back(head[vertex]);
      head[vertex] = copy;
    }
    split.indices.push_back(copy);
  }
  split.name = std::move(mesh.name);
  split.primitives = std::move(mesh.primitives);
  mesh = std::move(split);
}

}  // namespace penumbra::scenes
