#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

/// Shadows by rays in double precision that start on the surface itself, over the scene as written:
/// no offset, no re-centring, nothing shared with the renderer. Everything drawn is judged by them.
namespace penumbra::experiments::stability {

class ExactRays {
 public:
  explicit ExactRays(const Scene& scene);

  struct Hit {
    double distance;  ///< in lengths of the direction
    std::uint32_t triangle;
    glm::dvec3 normal;  ///< of the facet, unit, against the ray
    bool from_behind;   ///< the facet's corners run clockwise as seen from where the ray comes
  };
  /// Nearest surface from `from` along `along`, beyond `after`.
  std::optional<Hit> nearest(const glm::dvec3& from, const glm::dvec3& along, double after) const;

  /// Whether a caster other than triangle `own`, where the ray starts, stands before its end.
  /// Triangles in whose plane the start lies, but for its rounding, hide nothing from it: of bodies
  /// that coincide none shadows the other's surface.
  bool hidden(const glm::dvec3& from, const glm::dvec3& along, std::uint32_t own) const;

 private:
  struct Triangle {
    std::array<glm::dvec3, 3> corners;
    bool casts;
  };
  struct Node {
    Bounds box;
    std::uint32_t first, count;  ///< triangles; a leaf where count > 0
    std::uint32_t right;         ///< the left child follows
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  /// Calls `meet(triangle, distance)` for the triangles on the ray, which may bring `until` nearer.
  template <class Meet>
  void walk(const glm::dvec3& from, const glm::dvec3& along, double& until, const Meet& meet) const;

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace penumbra::experiments::stability
