#include "renderer/shadow_volumes/coverage_table.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace penumbra::shadow_volumes {
namespace {

constexpr double pi = glm::pi<double>();

/// Light per radian that lies outside `radius` in a direction, of a light of 1 in all.
double light_outside(LightShape shape, double direction, double radius) {
  switch (shape) {
    case LightShape::disc:
      return std::max(0.0, 1.0 - radius * radius) / (2.0 * pi);
    case LightShape::ball:
      // The integral of 3 / (2 pi) sqrt(1 - r^2) r dr from radius to 1.
      return std::pow(std::max(0.0, 1.0 - radius * radius), 1.5) / (2.0 * pi);
    case LightShape::square: {
      const double border =
          1.0 / std::max(std::abs(std::cos(direction)), std::abs(std::sin(direction)));
      return std::max(0.0, border * border - radius * radius) / 8.0;
    }
  }
  return 0.0;
}

/// Light beyond the line between two angles from its foot, by Gauss's rule of three points.
double light_between(LightShape shape, double direction, double distance, double from, double to) {
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  double sum = 0.0;
  for (const int side : {-1, 0, 1}) {
    const double angle = middle + side * std::sqrt(0.6) * half;
    const double radius = distance / std::max(std::cos(angle), 1e-12);
    sum += (side == 0 ? 8.0 : 5.0) / 9.0 * light_outside(shape, direction + angle, radius);
  }
  return sum * half;
}

}  // namespace

double part_beyond_line(LightShape shape, double direction, double distance, double angle) {
  if (shape == LightShape::disc) {
    const double reach = distance < 1.0 ? std::acos(distance) : 0.0;
    const double inside = std::clamp(angle, -reach, reach);
    return (inside - distance * distance * std::tan(inside)) / (2.0 * pi);
  }
  constexpr int steps = 64;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
    sum += light_between(shape, direction, distance, angle * i / steps, angle * (i + 1) / steps);
  return sum;
}

std::vector<glm::dvec2> light_lattice(LightShape shape, std::uint32_t count) {
  std::vector<glm::dvec2> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec2 u((i + 0.5) / count,
                       glm::fract((i + 0.5) * (glm::golden_ratio<double>() - 1)));
    if (shape == LightShape::square) {
      points.push_back(2.0 * u - 1.0);
      continue;
    }
    // Radius outside which a share u.x of the light lies.
    const double power = shape == LightShape::ball ? 2.0 / 3.0 : 1.0;
    const double radius = std::sqrt(1.0 - std::pow(u.x, power));
    points.push_back(radius * glm::dvec2(std::cos(2.0 * pi * u.y), std::sin(2.0 * pi * u.y)));
  }
  return points;
}

CoverageTable make_coverage_table(LightShape shape, std::uint32_t size) {
  CoverageTable table;
  table.size = size;
  const bool square = shape == LightShape::square;
  table.directions = square ? size / 4 + 2 : 1;
  table.range = square ? std::sqrt(2.0f) : 1.0f;
  table.values.reserve(std::size_t{table.directions} * size * size);
  const double step = pi / (size - 1);
  // A step of a coarse table is integrated in parts.
  const int parts = static_cast<int>(std::max(1u, 64 / size));
  for (std::uint32_t k = 0; k < table.directions; ++k) {
    const double direction = square ? 0.5 * pi * k / (table.directions - 1) : 0.0;
    for (std::uint32_t i = 0; i < size; ++i) {
      const double distance = static_cast<double>(table.range) * i / (size - 1);
      double sum = part_beyond_line(shape, direction, distance, -0.5 * pi);
      for (std::uint32_t j = 0; j < size; ++j) {
        const double angle = -0.5 * pi + step * j;
        if (shape == LightShape::disc) sum = part_beyond_line(shape, direction, distance, angle);
        table.values.push_back(static_cast<float>(sum));
        if (shape == LightShape::disc) continue;
        for (int part = 0; part < parts; ++part)
          sum += light_between(shape, direction, distance, angle + step * part / parts,
                               angle + step * (part + 1) / parts);
      }
    }
  }
  return table;
}

}  // namespace penumbra::shadow_volumes
