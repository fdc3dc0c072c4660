#include "experiments/stability/exact_rays.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra::experiments::stability {

namespace {

/// Whether a point is no farther from a triangle's plane than its coordinates are rounded.
bool lies_in_plane(const glm::dvec3& point, const std::array<glm::dvec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const glm::dvec3 largest =
      glm::max(glm::abs(point), glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c))));
  const double rounding = 64.0 * 0x1p-53 * std::max({largest.x, largest.y, largest.z});
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  return std::abs(glm::dot(normal, point - a)) <= rounding;
}

}  // namespace

ExactRays::ExactRays(const Scene& scene) {
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto corner = [&](std::uint32_t i) {
      const glm::dvec4 point(glm::dvec3(mesh.positions[i]), 1.0);
      return glm::dvec3(instance.world_from_object * point);
    };
    // A matrix that mirrors turns corners round; outside stays outside.
    const bool mirrors = glm::determinant(glm::dmat3(instance.world_from_object)) < 0.0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const glm::dvec3 a = corner(mesh.indices[i]), b = corner(mesh.indices[i + 1]),
                       c = corner(mesh.indices[i + 2]);
      triangles_.push_back({{a, mirrors ? c : b, mirrors ? b : c}, instance.casts_shadow});
    }
  }
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  build(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t ExactRays::build(std::uint32_t first, std::uint32_t count) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, first, count, 0});
  Bounds box;
  for (std::uint32_t i = first; i < first + count; ++i)
    for (const glm::dvec3& corner : triangles_[order_[i]].corners) box.add(corner);
  const glm::dvec3 extent = box.size();
  // Rounding of the slab test must lose nothing.
  box.low -= 1e-9 * (glm::abs(box.low) + extent);
  box.high += 1e-9 * (glm::abs(box.high) + extent);
  nodes_[index].box = box;
  if (count <= 4) return index;
  const int axis =
      extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
  const auto middle = order_.begin() + first + count / 2;
  std::nth_element(order_.begin() + first, middle, order_.begin() + first + count,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const auto& p = triangles_[a].corners;
                     const auto& q = triangles_[b].corners;
                     return p[0][axis] + p[1][axis] + p[2][axis] <
                            q[0][axis] + q[1][axis] + q[2][axis];
                   });
  nodes_[index].count = 0;
  build(first, count / 2);
  const std::uint32_t right = build(first + count / 2, count - count / 2);
  nodes_[index].right = right;
  return index;
}

template <class Meet>
void ExactRays::walk(const glm::dvec3& from, const glm::dvec3& along, double& until,
                     const Meet& meet) const {
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const std::uint32_t index = stack.back();
    const Node& node = nodes_[index];
    stack.pop_back();
    double enter = 0.0, leave = until;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (node.box.low[axis] - from[axis]) / along[axis];
      const double b = (node.box.high[axis] - from[axis]) / along[axis];
      // A ray along the slab gives infinities, or nothing where it lies in a face.
      enter = std::fmax(enter, std::fmin(a, b));
      leave = std::fmin(leave, std::fmax(a, b));
    }
    if (enter > leave) continue;
    if (node.count == 0) {
      stack.push_back(node.right);
      stack.push_back(index + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const auto& [a, b, c] = triangles_[order_[i]].corners;
      const glm::dvec3 normal = glm::cross(b - a, c - a);
      const double speed = glm::dot(normal, along);
      if (speed == 0.0) continue;
      const double distance = glm::dot(normal, a - from) / speed;
      // Volumes of the tetrahedra that the ray spans with each side.
      const double u = glm::dot(along, glm::cross(a - from, b - from));
      const double v = glm::dot(along, glm::cross(b - from, c - from));
      const double w = glm::dot(along, glm::cross(c - from, a - from));
      if (std::min({u, v, w}) >= 0.0 || std::max({u, v, w}) <= 0.0) meet(order_[i], distance);
    }
  }
}

std::optional<ExactRays::Hit> ExactRays::nearest(const glm::dvec3& from, const glm::dvec3& along,
                                                 double after) const {
  std::optional<Hit> found;
  double until = 1e30;
  walk(from, along, until, [&](std::uint32_t triangle, double distance) {
    if (distance <= after || distance >= until) return;
    until = distance;
    const auto& [a, b, c] = triangles_[triangle].corners;
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const bool behind = glm::dot(normal, along) > 0.0;
    found = {distance, triangle, behind ? -normal : normal, behind};
  });
  return found;
}

bool ExactRays::hidden(const glm::dvec3& from, const glm::dvec3& along, std::uint32_t own) const {
  bool found = false;
  double until = 1.0;
  walk(from, along, until, [&](std::uint32_t triangle, double distance) {
    if (triangle == own || !triangles_[triangle].casts || distance <= 0.0 || distance >= until)
      return;
    if (lies_in_plane(from, triangles_[triangle].corners)) return;
    found = true;
    until = 0.0;
  });
  return found;
}

}  // namespace penumbra::experiments::stability
