#include "scenes/import/model_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace penumbra::scenes {
namespace {

/// A vertex is a stray where it is this many times as far from the middle as the next nearer one,
/// and three quarters of all are nearer.
constexpr double widest_gap = 32.0;

/// Height of the layer at the bottom that may be a floor, as a share of the model's.
constexpr double floor_layer = 0.02;

template <class Visit>
void visit_vertices(const Scene& scene, const Visit& visit) {
  for (const Instance& instance : scene.instances)
    for (const glm::vec3& position : scene.meshes[instance.mesh].positions)
      visit(glm::dvec3(instance.world_from_object * glm::dvec4(position, 1.0)));
}

glm::dvec3 median_of(const std::vector<glm::dvec3>& points) {
  glm::dvec3 median;
  std::vector<double> values(points.size());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const glm::dvec3& point) { return point[axis]; });
    std::nth_element(values.begin(), middle, values.end());
    median[axis] = *middle;
  }
  return median;
}

/// Whether some edge belongs to one triangle only: a body that one may look into. Vertices of equal
/// position are one.
bool is_open(const Mesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> places;
  std::vector<std::uint32_t> place_of;
  for (const glm::vec3& p : mesh.positions)
    place_of.push_back(
        places.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(places.size()))
            .first->second);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::pair<std::uint32_t, std::uint32_t> edge =
          std::minmax(place_of[mesh.indices[i + k]], place_of[mesh.indices[i + (k + 1) % 3]]);
      ++edges[edge];
    }
  return std::any_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 1; });
}

/// Sum of the horizontal areas of facets in the bottom layer that look up. Double-sided ones may
/// look down too, unless they are the underside of a closed body.
double floor_area(const Scene& scene, const Bounds& bounds, double top) {
  double area = 0.0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const bool mirrored = glm::determinant(glm::dmat3(instance.world_from_object)) < 0.0;
    double underside = 0.0;
    for (const Primitive& primitive : mesh.primitives)
      for (std::uint32_t i = 0; i + 2 < primitive.index_count; i += 3) {
        glm::dvec3 corners[3];
        for (std::uint32_t k = 0; k < 3; ++k) {
          const glm::vec3& position = mesh.positions[mesh.indices[primitive.first_index + i + k]];
          corners[k] =
              glm::clamp(glm::dvec3(instance.world_from_object * glm::dvec4(position, 1.0)),
                         bounds.low, bounds.high);
        }
        if (std::max({corners[0].y, corners[1].y, corners[2].y}) > top) continue;
        const double up = 0.5 * glm::cross(corners[1] - corners[0], corners[2] - corners[0]).y *
                          (mirrored ? -1.0 : 1.0);
        area += std::max(up, 0.0);
        if (scene.materials[primitive.material].double_sided) underside += std::max(-up, 0.0);
      }
    if (underside > 0.0 && is_open(mesh)) area += underside;
  }
  return area;
}

bool has_floor(const Scene& scene, const Bounds& bounds) {
  const double top = bounds.low.y + floor_layer * bounds.size().y;
  Bounds rest;
  visit_vertices(scene, [&](const glm::dvec3& point) {
    if (point.y > top && glm::all(glm::lessThanEqual(point, bounds.high))) rest.add(point);
  });
  if (rest.empty()) return false;
  const double area = floor_area(scene, bounds, top);
  return area > 0.0 && area >= 0.5 * rest.size().x * rest.size().z;
}

}  // namespace

Model measure_model(const Scene& scene) {
  std::vector<glm::dvec3> points;
  visit_vertices(scene, [&](const glm::dvec3& point) { points.push_back(point); });
  Model model;
  if (points.empty()) return model;
  const glm::dvec3 middle = median_of(points);
  std::sort(points.begin(), points.end(), [&](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - middle) < glm::length(b - middle);
  });
  std::size_t kept = points.size();
  for (std::size_t i = std::max<std::size_t>(3 * points.size() / 4, 1); i < kept; ++i) {
    const double nearer = glm::length(points[i - 1] - middle);
    if (nearer > 0.0 && glm::length(points[i] - middle) > widest_gap * nearer) kept = i;
  }
  for (std::size_t i = 0; i < kept; ++i) model.bounds.add(points[i]);
  model.strays = points.size() - kept;
  model.has_floor = has_floor(scene, model.bounds);
  return model;
}

}  // namespace penumbra::scenes
