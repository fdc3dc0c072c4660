#include "renderer/shadow_maps/light_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/scene/convex_clip.h"

namespace penumbra::shadow_maps {
namespace {

/// Half angle of the widest spot light that is served by one view, degrees.
constexpr double widest_single_view = 75.0;

struct Axes {
  glm::dvec3 forward;
  glm::dvec3 up;
};

/// Clip matrix with w as the distance along forward; z is unused, since depth is written by shader.
glm::mat4 clip_matrix(const glm::dvec3& origin, const glm::dvec3& right, const glm::dvec3& down,
                      const glm::dvec3& forward, bool perspective) {
  // right and down are scaled: a = dot(v, right) / |right|^2.
  const glm::dvec3 x = right / glm::dot(right, right);
  const glm::dvec3 y = down / glm::dot(down, down);
  glm::dmat4 clip(0.0);
  const auto row = [&](int r, const glm::dvec3& axis) {
    for (int c = 0; c < 3; ++c) clip[c][r] = axis[c];
    clip[3][r] = -glm::dot(axis, origin);
  };
  row(0, x);
  row(1, y);
  if (perspective)
    row(3, forward);
  else
    clip[3][3] = 1.0;
  return glm::mat4(clip);
}

shader::MapFace make_face(const glm::dvec3& origin, const Axes& axes, double half_width,
                          double half_height, bool perspective, double size) {
  const glm::dvec3 right = glm::cross(axes.forward, axes.up) * half_width;
  const glm::dvec3 down = -axes.up * half_height;
  shader::MapFace face{};
  face.clip_from_world = clip_matrix(origin, right, down, axes.forward, perspective);
  face.origin = glm::vec4(origin, perspective ? 1.0 : 0.0);
  face.right = glm::vec4(right, 0.0);
  face.up = glm::vec4(down, 0.0);
  face.forward = glm::vec4(axes.forward, 2.0 * half_width / size);
  return face;
}

/// Widens near..far by the part of a box between the face's side planes. A box that reaches past
/// them would else begin behind the light.
void extend_range(const shader::MapFace& face, const Bounds& box, const GpuScene& scene,
                  double& near, double& far) {
  const Bounds world = scene.near_part(box);
  if (world.empty()) return;
  const auto sides = side_planes(glm::dmat4(face.clip_from_world));
  const glm::dvec3 origin(face.origin);
  if (contains(world, origin)) near = std::min(near, 0.0);
  visit_clipped_corners(world, sides, [&](const glm::dvec3& point) {
    const double distance = glm::dot(point - origin, glm::dvec3(face.forward));
    near = std::min(near, distance);
    far = std::max(far, distance);
  });
}

/// What a directional light's map covers: the whole scene, or what is seen of it where it reaches
/// too far.
Bounds covered(const GpuScene& scene, const LightFit& fit) {
  const Bounds whole{scene.low(), scene.high()};
  if (!scene.is_far()) return whole;
  Bounds seen;
  for (const Bounds& box : fit.receivers)
    if (const Bounds part = scene.near_part(box); !part.empty()) seen.add(part);
  return seen.empty() ? whole : seen;
}

Bounds bounds_along(const Bounds& box, const Axes& axes) {
  const glm::dvec3 right = glm::cross(axes.forward, axes.up);
  Bounds bounds;
  const glm::dvec3 low = box.low;
  const glm::dvec3 high = box.high;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                           (corner & 4) != 0 ? high.z : low.z);
    bounds.add({glm::dot(point, right), glm::dot(point, axes.up), glm::dot(point, axes.forward)});
  }
  return bounds;
}

/// A wide cone's one view would have few texels left for its middle, and none beyond a right angle.
bool has_six_faces(const WorldLight& light) {
  return light.kind == LightKind::point ||
         (light.kind == LightKind::spot && light.source->outer_angle > widest_single_view);
}

}  // namespace

std::uint32_t face_count(const Light& light) {
  return light.kind == LightKind::point ? 6 : 1;
}

LightView fit_light_view(const GpuScene& scene, const WorldLight& light, const LightFit& fit,
                         std::uint32_t map_size, double guard) {
  LightView view;
  const double widen = 1.0 / (1.0 - 2.0 * guard);
  double near = std::numeric_limits<double>::infinity();
  double far = -near;
  if (light.kind == LightKind::directional) {
    const Axes axes{light.direction, light.up};
    const glm::dvec3 right = glm::cross(axes.forward, axes.up);
    const Bounds bounds = bounds_along(covered(scene, fit), axes);
    const glm::dvec3 center = bounds.center();
    const double half = std::max(0.5 * std::max(bounds.size().x, bounds.size().y), 1e-6) * widen;
    const glm::dvec3 origin = center.x * right + center.y * axes.up + bounds.low.z * axes.forward;
    view.faces.push_back(make_face(origin, axes, half, half, false, map_size));
  } else {
    std::vector<Axes> axes{{light.direction, light.up}};
    double tangent = std::tan(glm::radians(light.source->outer_angle));
    if (has_six_faces(light)) {
      axes = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 0, 1}},
              {{0, -1, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 1, 0}},  {{0, 0, -1}, {0, 1, 0}}};
      tangent = 1.0;
    }
    const double half = tangent * widen;
    for (const Axes& face_axes : axes)
      view.faces.push_back(make_face(light.position, face_axes, half, half, true, map_size));
  }
  // Depth begins at the first box of either kind and ends at the last receiver: what lies behind it
  // shadows nothing.
  double unused = -near;
  for (const shader::MapFace& face : view.faces) {
    for (const Bounds& box : fit.casters) extend_range(face, box, scene, near, unused);
    for (const Bounds& box : fit.receivers) extend_range(face, box, scene, near, far);
  }
  if (!(far > 0.0)) far = 1.0;  // nothing before the light
  // A light inside the scene's boxes starts close to itself; linear depth loses nothing by that.
  near = std::clamp(near, light.kind == LightKind::directional ? 0.0 : 1e-4 * far, far);
  const double margin = 1e-4 * std::max(far - near, 1e-3 * far);
  view.near_distance = static_cast<float>(std::max(near - margin, 0.0));
  view.far_distance = static_cast<float>(far + margin);
  return view;
}

}  // namespace penumbra::shadow_maps
