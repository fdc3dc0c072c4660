#include "renderer/metrics/color.h"

#include <array>
#include <cmath>

namespace penumbra::metrics {
namespace {

/// Rows X, Y, Z; the exact fractions that follow from the primaries and the D65 white of sRGB.
const glm::dmat3 xyz_from_linear = glm::transpose(
    glm::dmat3{{10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
               {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
               {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}});

const glm::dvec3 white = xyz_from_linear * glm::dvec3(1.0);

/// XYZ relative to white, straight from linear RGB and back.
const glm::dmat3 relative_xyz_from_linear = [] {
  glm::dmat3 matrix = xyz_from_linear;
  for (int column = 0; column < 3; ++column) matrix[column] /= white;
  return matrix;
}();
const glm::dmat3 linear_from_relative_xyz = glm::inverse(relative_xyz_from_linear);

double lab_curve(double t) {
  constexpr double delta = 6.0 / 29.0;
  if (t > delta * delta * delta) return std::cbrt(t);
  return t / (3.0 * delta * delta) + 4.0 / 29.0;
}

glm::dvec3 lightness_and_opponents(const glm::dvec3& xyz) {
  return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

}  // namespace

double linear_from_srgb(float level) {
  const double v = static_cast<double>(level) / 255.0;
  return v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92;
}

double linear_from_srgb(std::uint8_t encoded) {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = linear_from_srgb(static_cast<float>(i));
    return values;
  }();
  return table[encoded];
}

glm::dvec3 opponent_from_linear(const glm::dvec3& rgb) {
  return lightness_and_opponents(relative_xyz_from_linear * rgb);
}

glm::dvec3 linear_from_opponent(const glm::dvec3& opponent) {
  const double y = (opponent.x + 16.0) / 116.0;
  return linear_from_relative_xyz * glm::dvec3(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
}

glm::dvec3 hunt_lab_from_linear(const glm::dvec3& rgb) {
  const glm::dvec3 xyz = relative_xyz_from_linear * rgb;
  const glm::dvec3 lab =
      lightness_and_opponents({lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z)});
  return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

double hyab_distance(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

}  // namespace penumbra::metrics
