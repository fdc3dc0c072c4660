#include "renderer/frame/split_triangles.h"

#include <algorithm>

namespace penumbra {
namespace {

/// An edge may be as long as this share of its distance from the origin: the floats of its ends are
/// then about as fine as those of its middle.
constexpr double longest_share = 0.5;

double distance_from_origin(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double squared = glm::dot(along, along);
  const double share = squared > 0.0 ? std::clamp(-glm::dot(a, along) / squared, 0.0, 1.0) : 0.0;
  return glm::length(a + share * along);
}

}  // namespace

TriangleSplitter::TriangleSplitter(double short_edge, std::uint32_t next_index, Corner corner)
    : short_edge_(short_edge), next_index_(next_index), corner_(std::move(corner)) {}

FineVertex TriangleSplitter::vertex(std::uint32_t index) const {
  return index < next_index_ ? corner_(index) : new_vertices_[index - next_index_];
}

/// How much longer an edge is than it may be, m; zero where it is not.
double TriangleSplitter::excess(const FineVertex& a, const FineVertex& b) const {
  // Named in one order, so that both triangles at an edge get the same bits.
  const bool turned = std::lexicographical_compare(&b.position.x, &b.position.x + 3, &a.position.x,
                                                   &a.position.x + 3);
  const glm::dvec3& first = turned ? b.position : a.position;
  const glm::dvec3& second = turned ? a.position : b.position;
  const double allowed = std::max(short_edge_, longest_share * distance_from_origin(first, second));
  return std::max(glm::length(second - first) - allowed, 0.0);
}

std::uint32_t TriangleSplitter::middle_of(std::uint32_t a, std::uint32_t b) {
  const auto [slot, is_new] = middles_.try_emplace(
      std::minmax(a, b), next_index_ + static_cast<std::uint32_t>(new_vertices_.size()));
  if (is_new) {
    const FineVertex from = vertex(a), to = vertex(b);
    new_vertices_.push_back({0.5 * (from.position + to.position), 0.5f * (from.normal + to.normal),
                             0.5f * (from.uv + to.uv), 0.5f * (from.color + to.color)});
  }
  return slot->second;
}

std::vector<TriangleSplitter::Triangle> TriangleSplitter::split(const Triangle& triangle) {
  std::vector<Triangle> parts, open{triangle};
  while (!open.empty()) {
    const Triangle whole = open.back();
    open.pop_back();
    std::array<FineVertex, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = vertex(whole[k]);
    std::array<double, 3> excesses;
    for (std::size_t k = 0; k < 3; ++k) excesses[k] = excess(corners[k], corners[(k + 1) % 3]);
    const auto longest = std::max_element(excesses.begin(), excesses.end());
    if (*longest == 0.0) {
      parts.push_back(whole);
      continue;
    }
    const auto k = static_cast<std::size_t>(longest - excesses.begin());
    const std::uint32_t from = whole[k], to = whole[(k + 1) % 3], other = whole[(k + 2) % 3];
    const std::uint32_t middle = middle_of(from, to);
    open.push_back({from, middle, other});
    open.push_back({middle, to, other});
  }
  return parts;
}

}  // namespace penumbra
