#include "scenes/import/seen_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/scene/coverage.h"
#include "renderer/scene/transforms.h"

namespace penumbra::scenes {
namespace {

using Corners = std::array<glm::dvec3, 3>;  // in view space: forward is -z

/// Rays through a square picture: x and y of a cell are tangents, or metres where orthographic.
class Grid {
 public:
  Grid(const Camera& camera, int side)
      : perspective_(camera.projection == Projection::perspective),
        half_(perspective_ ? std::tan(glm::radians(0.5 * camera.vertical_fov))
                           : 0.5 * camera.orthographic_height),
        near_(camera.near_plane),
        side_(side),
        hits_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

  /// Keeps the facet where it is nearer than what was there.
  void draw(const Corners& corners, bool culled) {
    glm::ivec2 first(0), last(side_ - 1);
    if (!cells(corners, first, last)) return;
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const glm::dvec2 at((2.0 * (x + 0.5) / side_ - 1.0) * half_,
                            (1.0 - 2.0 * (y + 0.5) / side_) * half_);
        const glm::dvec3 origin = perspective_ ? glm::dvec3(0.0) : glm::dvec3(at, 0.0);
        const glm::dvec3 way = perspective_ ? glm::dvec3(at, -1.0) : glm::dvec3(0.0, 0.0, -1.0);
        const double facing = glm::dot(normal, way);
        if (facing == 0.0 || (culled && facing > 0.0)) continue;
        Hit& hit = hits_[static_cast<std::size_t>(y * side_ + x)];
        const double depth = glm::dot(normal, corners[0] - origin) / facing;
        if (!(depth > near_ && depth < hit.depth)) continue;
        const glm::dvec3 point = origin + depth * way;
        if (inside(corners, normal, point))
          hit = {depth, point, glm::normalize(facing > 0.0 ? -normal : normal)};
      }
  }

  std::vector<SeenPoint> points(const glm::dmat4& world_from_view) const {
    std::vector<SeenPoint> points;
    for (const Hit& hit : hits_)
      if (std::isfinite(hit.depth))
        points.push_back({glm::dvec3(world_from_view * glm::dvec4(hit.point, 1.0)),
                          glm::dmat3(world_from_view) * hit.normal});
    return points;
  }

 private:
  struct Hit {
    double depth = std::numeric_limits<double>::infinity();
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0};
  };

  /// Which cells a facet may cover; false where none. One that reaches behind the near plane may
  /// cover all.
  bool cells(const Corners& corners, glm::ivec2& first, glm::ivec2& last) const {
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    int behind = 0;
    for (const glm::dvec3& corner : corners) {
      const double depth = -corner.z;
      if (depth <= near_) {
        ++behind;
        continue;
      }
      const glm::dvec2 at = glm::dvec2(corner) / ((perspective_ ? depth : 1.0) * half_);
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    if (behind == 3) return false;
    if (behind > 0) return true;
    // Rows count from the top.
    const auto cell = [&](double at) { return 0.5 * (at + 1.0) * side_ - 0.5; };
    const auto bounded = [&](double value) {
      return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(side_)));
    };
    first = {bounded(std::ceil(cell(low.x))), bounded(std::ceil(cell(-high.y)))};
    last = {bounded(std::floor(cell(high.x))), bounded(std::floor(cell(-low.y)))};
    first = glm::max(first, glm::ivec2(0));
    last = glm::min(last, glm::ivec2(side_ - 1));
    return first.x <= last.x && first.y <= last.y;
  }

  static bool inside(const Corners& corners, const glm::dvec3& normal, const glm::dvec3& point) {
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
      if (glm::dot(glm::cross(edge, point - corners[i]), normal) < 0.0) return false;
    }
    return true;
  }

  bool perspective_;
  double half_, near_;
  int side_;
  std::vector<Hit> hits_;
};

}  // namespace

std::vector<SeenPoint> seen_points(const Scene& scene, const Camera& camera, int side) {
  const glm::dmat4 view =
      view_from_world(camera.position, camera.target - camera.position, camera.up);
  Grid grid(camera, side);
  std::vector<glm::dvec3> positions;
  Coverages coverages(scene);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::dmat4 view_from_object = view * instance.world_from_object;
    const bool mirrored = glm::determinant(glm::dmat3(view_from_object)) < 0.0;
    positions.clear();
    for (const glm::vec3& position : mesh.positions)
      positions.push_back(glm::dvec3(view_from_object * glm::dvec4(position, 1.0)));
    for (const Primitive& primitive : mesh.primitives) {
      if (coverages.of(mesh, primitive) == Coverage::nothing) continue;
      const bool culled = !scene.materials[primitive.material].double_sided;
      for (std::uint32_t i = 0; i + 2 < primitive.index_count; i += 3) {
        const std::uint32_t* corner = &mesh.indices[primitive.first_index + i];
        Corners corners{positions[corner[0]], positions[corner[1]], positions[corner[2]]};
        if (mirrored) std::swap(corners[1], corners[2]);
        grid.draw(corners, culled);
      }
    }
  }
  return grid.points(glm::inverse(view));
}

}  // namespace penumbra::scenes
