#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/scene.h"
#include "renderer/shaders/shader_types.h"

/// What depends on the kind of a light or of its extent: everything else asks here, and shaders ask
/// renderer/shaders/light.glsl. Homogeneous coordinates spare most questions: from a point p the
/// way to a light's centre is center.xyz - center.w * p, whether it has a place or not.
namespace penumbra {

/// The kinds, by the names that scenes and glTF give them.
const std::vector<std::pair<const char*, LightKind>>& light_kinds();
const std::vector<std::pair<const char*, ExtentKind>>& extent_kinds();
std::string name_of(LightKind kind);

/// Whether all its rays are parallel: it has a direction, but no place.
bool is_at_infinity(const Light& light);

/// (position, 1), or at infinity (unit direction towards it, 0).
glm::dvec4 center_of(const Light& light);

/// Half angle of the cone that its rays spread over, degrees: 0 where they are parallel, 180 where
/// it shines all around.
double beam_half_angle(const Light& light);

struct Cone {
  double inner_angle, outer_angle;  ///< half angles of full brightness and of the end, degrees
};
/// Empty for a light whose brightness is the same in all directions that it shines in.
std::optional<Cone> cone_of(const Light& light);

/// Distance beyond which it gives no light, m; 0: unlimited.
double range_of(const Light& light);

/// Share of its intensity that is left at a distance of its centre, and in a direction.
double attenuation_at(const Light& light, double distance);
double cone_strength(const Light& light, const glm::dvec3& unit_to_light);

/// Whether its shadows have penumbrae, however small.
bool has_extent(const Light& light);

/// Whether all of its extent is before the scene, which limits angles alone.
bool is_extent_valid(const Light& light);

/// Half sizes of a box around the extent in the light's own axes, along right, up and direction:
/// metres, or tangents of the angle at infinity.
glm::dvec3 extent_half_size(const Light& light);

/// Radius of the sphere around the extent's centre that holds all of it, likewise.
double extent_radius(const Light& light);

/// Place of a point of the unit cube on (sphere: in) the extent, from its centre in the same axes
/// and units; even over area or ball for even points.
glm::dvec3 extent_offset(const Light& light, const glm::dvec3& u);

/// How the light of an extent is spread over its outline, as surfaces see it.
enum class LightShape {
  disc,    ///< evenly over the unit disc
  ball,    ///< over the unit disc as an evenly filled ball is, seen from far away
  square,  ///< evenly over the square from -1 to 1
};
LightShape shape_of(const Light& light);

/// Multiplies the light's lengths; angles stay.
void scale_lengths(Light& light, double factor);

/// A light in the renderer's world space.
struct WorldLight {
  glm::dvec4 center{0.0};                ///< as of center_of
  glm::dvec3 position{0.0};              ///< unused at infinity
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< unit, into the scene
  glm::dvec3 right{1.0, 0.0, 0.0};       ///< unit, along a rectangle's width
  glm::dvec3 up{0.0, 0.0, 1.0};          ///< unit, along its height
  const Light* source = nullptr;

  /// From a point to the centre, m; at infinity the unit direction.
  glm::dvec3 to_center(const glm::dvec3& point) const {
    return glm::dvec3(center) - center.w * point;
  }
  /// What distances along its rays are measured from: its centre, or the world's origin.
  glm::dvec3 origin() const { return center.w * glm::dvec3(center); }

  /// Unit direction of its centre's ray through a point other than that.
  glm::dvec3 ray_direction(const glm::dvec3& point) const;

  /// The point at an offset of extent_offset: a position, or the unit direction to it at infinity.
  glm::dvec3 extent_point(const glm::dvec3& offset) const;

  /// Whether its centre lies in a box; never at infinity.
  bool is_within(const Bounds& box) const;

  /// False only if none of a ball is inside its cone and range.
  bool may_reach(const glm::dvec3& middle, double radius) const;
};

WorldLight world_light(const Light& light, const glm::dvec3& origin);

/// As shaders see it; `points` in the batch and `weight` of the batch are the caller's.
shader::LightData light_data(const WorldLight& light, float points, float weight);

/// What a light and its extent can reach of boxes, and what lies between, in the scene's space.
class LightReach {
 public:
  explicit LightReach(const Light& light);

  bool shines() const;

  /// Box around what the light reaches within `box`.
  Bounds lit(const Bounds& box) const;

  /// Whether something within `caster` may lie between the light and something within `lit`.
  bool may_shadow(const Bounds& caster, const Bounds& lit) const;

  /// Distances of a box's nearest and farthest point: along the light's axis where it has one, from
  /// the light's own place or, at infinity, from the scene's origin; metres.
  glm::dvec2 distances(const Bounds& box) const;

  /// Whether a box may touch the cone around the centre, its tangent widened by a factor.
  bool may_touch_cone(const Bounds& box, double widened) const;

 private:
  const Light& light_;
  glm::dvec3 direction_;
  double radius_;
};

}  // namespace penumbra
