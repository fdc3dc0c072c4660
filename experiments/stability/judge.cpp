#include "experiments/stability/judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <stdexcept>

#include "experiments/stability/exact_rays.h"

namespace penumbra::experiments::stability {
namespace {

/// How far a pixel's sample is moved to see whether its value is firm, in pixels.
constexpr double firmness = 0.04;
/// Points of an extent that are looked at for that.
constexpr std::uint32_t firm_points = 16;
/// By how much the share that is seen may change there.
constexpr double firm_change = 0.1;
/// Facets that face the light by less (sine) lie in its direction's plane: either is right.
constexpr double least_facing = 1e-6;
/// Light below which a pixel says nothing about a lamp that went out.
constexpr double least_light = 1e-6;
/// Share of a cone's strength below which its border is near: there floats may see none.
constexpr double least_strength = 0.02;

/// Evenly spread points of the unit cube (Roberts 2018, R3).
glm::dvec3 spread_point(std::uint32_t index) {
  constexpr double g = 1.22074408460575947536;
  const double n = index + 1.0;
  const glm::dvec3 point = 0.5 + n * glm::dvec3(1.0 / g, 1.0 / (g * g), 1.0 / (g * g * g));
  return glm::fract(point);
}

/// Directions of the light's own axes; `right` and `up` span a rectangle.
struct Frame {
  glm::dvec3 right, up, direction;
};

Frame frame_of(const Light& light) {
  const glm::dvec3 direction = glm::normalize(light.direction);
  const glm::dvec3 right = glm::normalize(glm::cross(direction, light.up));
  return {right, glm::cross(right, direction), direction};
}

/// Places of the light's points, or ways to them where it is directional.
std::vector<glm::dvec3> points_of(const Light& light, std::uint32_t count) {
  const Frame frame = frame_of(light);
  const bool directional = light.kind == LightKind::directional;
  const auto length = [&](double x) { return directional ? std::tan(glm::radians(x)) : x; };
  std::vector<glm::dvec3> points;
  for (std::uint32_t i = 0; i < (light.extent.kind == ExtentKind::none ? 1u : count); ++i) {
    const glm::dvec3 u = spread_point(i);
    const double phi = 2.0 * glm::pi<double>() * u.x;
    glm::dvec3 place(0.0);
    if (light.extent.kind == ExtentKind::rectangle) {
      place = {length(0.5 * light.extent.size.x) * (2.0 * u.x - 1.0),
               length(0.5 * light.extent.size.y) * (2.0 * u.y - 1.0), 0.0};
    } else if (light.extent.kind == ExtentKind::sphere && !directional) {
      const double z = 2.0 * u.y - 1.0, ring = std::sqrt(1.0 - z * z);
      place = light.extent.radius * std::cbrt(u.z) *
              glm::dvec3(ring * std::cos(phi), ring * std::sin(phi), z);
    } else if (light.extent.kind != ExtentKind::none) {
      const double radius = length(light.extent.radius) * std::sqrt(u.y);
      place = radius * glm::dvec3(std::cos(phi), std::sin(phi), 0.0);
    }
    const glm::dvec3 moved = place.x * frame.right + place.y * frame.up + place.z * frame.direction;
    points.push_back(directional ? moved - frame.direction : light.position + moved);
  }
  return points;
}

/// The strength of a spot by its angle, as the schema defines it: all within `inner`, none beyond
/// `outer`, smooth in the cosine between. In double the cosines of angles of 1e-3 degrees still
/// differ.
double spot_strength(const Light& light, const glm::dvec3& unit_to_light) {
  if (light.kind != LightKind::spot) return 1.0;
  const double cosine = -glm::dot(unit_to_light, glm::normalize(light.direction));
  const double inner = std::cos(glm::radians(light.inner_angle));
  const double outer = std::cos(glm::radians(light.outer_angle));
  if (inner <= outer) return cosine >= outer ? 1.0 : 0.0;
  const double t = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// One sample: nothing where it is not judged.
struct Sample {
  double visible, light;
};

class Judge {
 public:
  Judge(const Scene& scene, std::uint32_t width, std::uint32_t height, std::uint32_t points)
      : scene_(scene),
        light_(scene.lights.at(0)),
        rays_(scene),
        points_(points_of(light_, points)),
        width_(width),
        height_(height) {
    const Bounds bounds = world_bounds(scene);
    beyond_ = 4.0 * (bounds.size().x + bounds.size().y + bounds.size().z) +
              glm::length(scene.cameras.at(0).position - bounds.center());
  }

  /// The sample at a place of the picture, by the first `count` points.
  std::optional<Sample> sample(const glm::dvec2& place, std::size_t count) const {
    const Camera& camera = scene_.cameras.front();
    const ViewRay view = view_ray(camera, place, width_, height_);
    auto hit = rays_.nearest(view.from, view.along, camera.near_plane);
    // Subjects are of one material; what is not double-sided is not seen from behind.
    while (hit && hit->from_behind && !scene_.materials[0].double_sided)
      hit = rays_.nearest(view.from, view.along, hit->distance);
    if (!hit) return std::nullopt;
    const glm::dvec3 position = view.from + hit->distance * view.along;
    const bool directional = light_.kind == LightKind::directional;
    const auto way = [&](const glm::dvec3& point) {
      return directional ? beyond_ * point : point - position;
    };
    count = std::min(count, points_.size());
    std::size_t seen = 0;
    double light = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 to_point = way(points_[i]);
      const double cosine = glm::dot(hit->normal, glm::normalize(to_point));
      // Where part of the light lies below the facet, shares are a matter of definition.
      if (cosine < least_facing) return std::nullopt;
      light += cosine * spot_strength(light_, glm::normalize(to_point));
      seen += !rays_.hidden(position, to_point, hit->triangle);
    }
    const glm::dvec3 center =
        glm::normalize(directional ? -light_.direction : light_.position - position);
    const double strength = spot_strength(light_, center);
    if (strength < least_strength) return std::nullopt;
    // Light may be taken from the centre or from every point: the lesser is owed by both.
    const auto points = static_cast<double>(count);
    light = std::min(light / points, strength * glm::dot(hit->normal, center));
    return Sample{static_cast<double>(seen) / points, light_.intensity * light};
  }

  /// The middle of a pixel, if its value does not change a little beside it.
  std::optional<Sample> pixel(std::uint32_t x, std::uint32_t y) const {
    const glm::dvec2 middle(x + 0.5, y + 0.5);
    const std::size_t few = std::min<std::size_t>(points_.size(), firm_points);
    double low = 1.0, high = 0.0;
    for (const glm::dvec2& corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(-1, 1),
                                     glm::dvec2(1, 1), glm::dvec2(0, 0)}) {
      const auto beside = sample(middle + firmness * corner, few);
      if (!beside) return std::nullopt;
      low = std::min(low, beside->visible);
      high = std::max(high, beside->visible);
    }
    if (high - low > firm_change) return std::nullopt;
    return sample(middle, points_.size());
  }

 private:
  const Scene& scene_;
  const Light& light_;
  ExactRays rays_;
  std::vector<glm::dvec3> points_;
  std::uint32_t width_, height_;
  double beyond_;  ///< length of a way to a directional light: out of the scene
};

}  // namespace

ViewRay view_ray(const Camera& camera, const glm::dvec2& across, std::uint32_t width,
                 std::uint32_t height) {
  const glm::dvec3 forward = glm::normalize(camera.target - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const double aspect = static_cast<double>(width) / height;
  const glm::dvec3 aside =
      aspect * (2.0 * across.x / width - 1.0) * right + (1.0 - 2.0 * across.y / height) * up;
  if (camera.projection == Projection::orthographic)
    return {camera.position + 0.5 * camera.orthographic_height * aside, forward};
  return {camera.position, forward + std::tan(glm::radians(0.5 * camera.vertical_fov)) * aside};
}

Truth judge(const Scene& scene, std::uint32_t width, std::uint32_t height, std::uint32_t points) {
  if (scene.lights.size() != 1) throw std::logic_error("scenes with one light are judged");
  const Judge judge(scene, width, height, points);
  Truth truth{width, height, {}, {}};
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const auto sample = judge.pixel(x, y);
      truth.visible.push_back(sample ? static_cast<float>(sample->visible) : -1.0f);
      truth.light.push_back(sample ? sample->light : 0.0);
    }
  return truth;
}

Verdict compare(const Truth& truth, const Scene& scene, const RenderResult& result) {
  Verdict verdict;
  verdict.non_finite = result.non_finite_pixels;
  // As the geometry buffer keeps it: square roots in 255 steps.
  const glm::dvec3 root =
      glm::round(255.0 * glm::sqrt(glm::dvec3(scene.materials.at(0).base_color)));
  const glm::dvec3 base = root * root / (255.0 * 255.0);
  const glm::dvec3 ambient = base * glm::dvec3(scene.ambient);
  const double exposure = scene.exposure;
  double squares = 0.0;
  for (std::size_t i = 0; i < truth.visible.size(); ++i) {
    const double wanted = truth.visible[i];
    if (wanted < 0.0) continue;
    ++verdict.judged;
    verdict.shadowed += wanted < 0.5;
    const double drawn = result.judged.pixels[i] > 0.0f ? result.visibility.pixels[i] : 0.0;
    // A value that is no number is as wrong as can be.
    const double error = std::isfinite(drawn) ? drawn - wanted : 1.0;
    squares += error * error;
    (error > 0.0 ? verdict.missing_shadow : verdict.false_shadow) += std::abs(error);
    // Green alone: subjects are grey.
    const double light = base.g * scene.lights[0].color.g * truth.light[i];
    if (wanted < 1.0 || light < least_light) continue;
    ++verdict.lit;
    const double added =
        static_cast<double>(result.linear.pixels[result.linear.channels * i + 1]) / exposure -
        ambient.g;
    verdict.dark += !(added >= 0.5 * light);
  }
  if (verdict.judged > 0) verdict.visibility_rms = std::sqrt(squares / verdict.judged);
  return verdict;
}

}  // namespace penumbra::experiments::stability
