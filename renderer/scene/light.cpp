#include "renderer/scene/light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "renderer/scene/convex_clip.h"
#include "renderer/scene/transforms.h"

namespace penumbra {
namespace {

/// 1 - cos, which a float of the cosine loses at small angles.
double versine(double degrees) {
  const double sine = std::sin(0.5 * glm::radians(degrees));
  return 2.0 * sine * sine;
}

/// Concentric map of the square onto the unit disc (Shirley and Chiu 1997).
glm::dvec2 disc(double u, double v) {
  const double a = 2.0 * u - 1.0;
  const double b = 2.0 * v - 1.0;
  if (a == 0.0 && b == 0.0) return {0.0, 0.0};
  const double quarter = glm::pi<double>() / 4.0;
  if (std::abs(a) > std::abs(b))
    return a * glm::dvec2(std::cos(quarter * b / a), std::sin(quarter * b / a));
  return b * glm::dvec2(std::cos(2.0 * quarter - quarter * a / b),
                        std::sin(2.0 * quarter - quarter * a / b));
}

/// A length of the extent as its points are measured: metres, or the tangent of its angle.
double extent_length(const Light& light, double size) {
  return is_at_infinity(light) ? std::tan(glm::radians(size)) : size;
}

/// The four half-spaces around a light's cone of this tangent, from its tip.
std::vector<HalfSpace> pyramid(const Light& light, const glm::dvec3& tip, double tangent) {
  const glm::dvec3 direction = glm::normalize(light.direction);
  const glm::dvec3 up = across(direction, light.up);
  const glm::dvec3 right = glm::cross(direction, up);
  std::vector<HalfSpace> sides;
  for (const glm::dvec3& axis : {right, -right, up, -up}) {
    const glm::dvec3 inwards = tangent * direction + axis;
    sides.emplace_back(inwards, -glm::dot(inwards, tip));
  }
  return sides;
}

}  // namespace

const std::vector<std::pair<const char*, LightKind>>& light_kinds() {
  static const std::vector<std::pair<const char*, LightKind>> list = {
      {"spot", LightKind::spot},
      {"directional", LightKind::directional},
      {"point", LightKind::point}};
  return list;
}

const std::vector<std::pair<const char*, ExtentKind>>& extent_kinds() {
  static const std::vector<std::pair<const char*, ExtentKind>> list = {
      {"none", ExtentKind::none},
      {"sphere", ExtentKind::sphere},
      {"disc", ExtentKind::disc},
      {"rectangle", ExtentKind::rectangle}};
  return list;
}

std::string name_of(LightKind kind) {
  return light_kinds().at(static_cast<std::size_t>(kind)).first;
}

bool is_at_infinity(const Light& light) {
  return light.kind == LightKind::directional;
}

glm::dvec4 center_of(const Light& light) {
  return is_at_infinity(light) ? glm::dvec4(-light.direction, 0.0)
                               : glm::dvec4(light.position, 1.0);
}

double beam_half_angle(const Light& light) {
  if (is_at_infinity(light)) return 0.0;
  return light.kind == LightKind::spot ? light.outer_angle : 180.0;
}

std::optional<Cone> cone_of(const Light& light) {
  if (light.kind != LightKind::spot) return std::nullopt;
  return Cone{light.inner_angle, light.outer_angle};
}

double range_of(const Light& light) {
  return is_at_infinity(light) ? 0.0 : light.range;
}

double attenuation_at(const Light& light, double distance) {
  const double range = range_of(light);
  if (range > 0.0 && distance > range) return 0.0;
  const bool attenuated =
      light.attenuation == Attenuation::inverse_square && !is_at_infinity(light);
  return attenuated ? 1.0 / (distance * distance) : 1.0;
}

double cone_strength(const Light& light, const glm::dvec3& unit_to_light) {
  const auto cone = cone_of(light);
  if (!cone) return 1.0;
  const double inner = std::cos(glm::radians(cone->inner_angle));
  const double outer = std::cos(glm::radians(cone->outer_angle));
  const double cosine = -glm::dot(unit_to_light, light.direction);
  const double t = std::clamp((cosine - outer) / std::max(inner - outer, 1e-6), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

bool has_extent(const Light& light) {
  return light.extent.kind != ExtentKind::none;
}

bool is_extent_valid(const Light& light) {
  const LightExtent& extent = light.extent;
  return !is_at_infinity(light) ||
         (extent.radius < 90.0 && extent.size.x < 180.0 && extent.size.y < 180.0);
}

glm::dvec3 extent_half_size(const Light& light) {
  const double radius = extent_length(light, light.extent.radius);
  switch (light.extent.kind) {
    case ExtentKind::sphere:
      // Seen from far away the ball is a disc.
      return {radius, radius, is_at_infinity(light) ? 0.0 : radius};
    case ExtentKind::disc:
      return {radius, radius, 0.0};
    case ExtentKind::rectangle:
      return {extent_length(light, 0.5 * light.extent.size.x),
              extent_length(light, 0.5 * light.extent.size.y), 0.0};
    case ExtentKind::none:
      break;
  }
  return glm::dvec3(0.0);
}

double extent_radius(const Light& light) {
  const glm::dvec3 half = extent_half_size(light);
  return light.extent.kind == ExtentKind::rectangle ? glm::length(half) : half.x;
}

glm::dvec3 extent_offset(const Light& light, const glm::dvec3& u) {
  const glm::dvec3 half = extent_half_size(light);
  if (light.extent.kind == ExtentKind::rectangle)
    return half * glm::dvec3(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 0.0);
  if (half.z == 0.0) return half.x * glm::dvec3(disc(u.x, u.y), 0.0);
  const double z = 2.0 * u.y - 1.0;
  const double ring = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double phi = 2.0 * glm::pi<double>() * u.x;
  return half.x * std::cbrt(u.z) * glm::dvec3(ring * std::cos(phi), ring * std::sin(phi), z);
}

LightShape shape_of(const Light& light) {
  if (light.extent.kind == ExtentKind::rectangle) return LightShape::square;
  const bool ball = light.extent.kind == ExtentKind::sphere && !is_at_infinity(light);
  return ball ? LightShape::ball : LightShape::disc;
}

void scale_lengths(Light& light, double factor) {
  light.range *= factor;
  if (is_at_infinity(light)) return;
  light.extent.radius *= factor;
  light.extent.size *= factor;
}

glm::dvec3 WorldLight::ray_direction(const glm::dvec3& point) const {
  return is_at_infinity(*source) ? direction : glm::normalize(point - position);
}

glm::dvec3 WorldLight::extent_point(const glm::dvec3& offset) const {
  const glm::dvec3 moved = offset.x * right + offset.y * up + offset.z * direction;
  return is_at_infinity(*source) ? glm::normalize(moved - direction) : position + moved;
}

bool WorldLight::is_within(const Bounds& box) const {
  return center.w != 0.0 && contains(box, position);
}

bool WorldLight::may_reach(const glm::dvec3& middle, double radius) const {
  if (is_at_infinity(*source)) return true;
  const glm::dvec3 offset = middle - position;
  const double distance = glm::length(offset);
  const double range = range_of(*source);
  if (range > 0.0 && distance - radius > range) return false;
  const auto cone = cone_of(*source);
  if (!cone || distance <= radius) return true;
  const double angle = std::acos(glm::clamp(glm::dot(offset, direction) / distance, -1.0, 1.0));
  return angle - std::asin(radius / distance) <= glm::radians(cone->outer_angle) + 1e-6;
}

WorldLight world_light(const Light& light, const glm::dvec3& origin) {
  WorldLight world;
  world.position = light.position - origin;
  world.direction = glm::normalize(light.direction);
  world.center =
      is_at_infinity(light) ? glm::dvec4(-world.direction, 0.0) : glm::dvec4(world.position, 1.0);
  world.up = across(world.direction, light.up);
  world.right = glm::cross(world.direction, world.up);
  world.source = &light;
  return world;
}

shader::LightData light_data(const WorldLight& world, float points, float weight) {
  const Light& light = *world.source;
  const glm::dvec3 half = extent_half_size(light);
  shader::LightData data{};
  data.position = glm::vec4(world.position, static_cast<float>(light.kind));
  data.direction = glm::vec4(world.direction, light.range);
  data.color = glm::vec4(light.color * light.intensity,
                         light.attenuation == Attenuation::inverse_square ? 1.0f : 0.0f);
  data.cone = {std::cos(glm::radians(light.inner_angle)), std::cos(glm::radians(light.outer_angle)),
               points, weight};
  // A line of light is drawn as a thin strip: shaders divide by both sides.
  const double thinnest =
      light.extent.kind == ExtentKind::rectangle ? 1e-4 * std::max(half.x, half.y) : 0.0;
  data.extent = {static_cast<float>(light.extent.kind), std::max(half.x, thinnest),
                 std::max(half.y, thinnest), 0.0f};
  data.right = glm::vec4(world.right, versine(light.inner_angle));
  data.up = glm::vec4(world.up, versine(light.outer_angle));
  return data;
}

LightReach::LightReach(const Light& light)
    : light_(light), direction_(glm::normalize(light.direction)), radius_(extent_radius(light)) {}

bool LightReach::shines() const {
  return light_.intensity > 0.0f &&
         std::max({light_.color.r, light_.color.g, light_.color.b}) > 0.0f;
}

Bounds LightReach::lit(const Bounds& box) const {
  if (is_at_infinity(light_)) return box;
  if (light_.range > 0.0) {
    const glm::dvec3 nearest = glm::clamp(light_.position, box.low, box.high);
    if (glm::length(nearest - light_.position) > light_.range + radius_) return {};
  }
  const auto cone = cone_of(light_);
  if (!cone) return box;
  // The pyramid around all cones that begin on the extent, as seen from behind the light.
  const double tangent = std::tan(glm::radians(cone->outer_angle));
  const glm::dvec3 tip =
      light_.position - direction_ * radius_ * std::sqrt(1.0 + 1.0 / (tangent * tangent));
  return common_part(box, pyramid(light_, tip, tangent), {&tip, 1});
}

bool LightReach::may_shadow(const Bounds& caster, const Bounds& lit) const {
  // Light and lit box span the hull of all boxes (1 - t) light + t lit, 0 <= t <= 1; one at
  // infinity that of all boxes lit + t directions to it, t >= 0.
  const bool parallel = is_at_infinity(light_);
  const Bounds start =
      parallel ? lit : Bounds{light_.position - radius_, light_.position + radius_};
  const glm::dvec3 low_step = parallel ? -direction_ - radius_ : lit.low - start.low;
  const glm::dvec3 high_step = parallel ? -direction_ + radius_ : lit.high - start.high;
  double first = 0.0;
  double last = parallel ? std::numeric_limits<double>::infinity() : 1.0;
  // Keeps the t for which value + t * step <= limit.
  const auto restrict = [&](double value, double step, double limit) {
    const double room = limit - value;
    if (step > 0.0) last = std::min(last, room / step);
    if (step < 0.0) first = std::max(first, room / step);
    if (step == 0.0 && room < 0.0) last = -std::numeric_limits<double>::infinity();
  };
  for (int axis = 0; axis < 3; ++axis) {
    restrict(start.low[axis], low_step[axis], caster.high[axis]);
    restrict(-start.high[axis], -high_step[axis], -caster.low[axis]);
  }
  return first <= last;
}

glm::dvec2 LightReach::distances(const Bounds& box) const {
  const bool parallel = is_at_infinity(light_);
  if (!parallel && !cone_of(light_)) {
    const glm::dvec3 nearest = glm::clamp(light_.position, box.low, box.high);
    const glm::dvec3 reach = glm::abs(box.center() - light_.position) + 0.5 * box.size();
    return {glm::length(nearest - light_.position), glm::length(reach)};
  }
  const glm::dvec3 from = parallel ? glm::dvec3(0.0) : light_.position;
  const double middle = glm::dot(box.center() - from, direction_);
  const double half = 0.5 * glm::dot(box.size(), glm::abs(direction_));
  return {parallel ? middle - half : std::max(middle - half, 0.0), middle + half};
}

bool LightReach::may_touch_cone(const Bounds& box, double widened) const {
  const auto cone = cone_of(light_);
  if (!cone) return true;
  const double tangent = widened * std::tan(glm::radians(cone->outer_angle));
  return may_touch(box, pyramid(light_, light_.position, tangent));
}

}  // namespace penumbra
