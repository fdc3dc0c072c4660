#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>

namespace penumbra::scenes {

/// Seeded numbers that are the same on every machine: the engine is fixed by the C++ standard, the
/// distributions of the standard library are not, so the mapping to a range is ours.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine(seed) {}

  /// In [0, 1), 53 random bits.
  double uniform() { return static_cast<double>(engine() >> 11) * 0x1p-53; }
  double range(double low, double high) { return low + (high - low) * uniform(); }
  /// In 0..count - 1.
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(uniform() * count); }

 private:
  std::mt19937_64 engine;
};

/// Cosine and sine of an angle in degrees, on a grid of 2^-40: the last bits of the C library's
/// functions differ between machines, and scenes (hence render ids) must not.
inline glm::dvec2 circle(double degrees) {
  const double radians = degrees * 0.017453292519943295;
  return {std::round(std::cos(radians) * 0x1p40) * 0x1p-40,
          std::round(std::sin(radians) * 0x1p40) * 0x1p-40};
}

/// Turn around the vertical axis, counter-clockwise seen from above, degrees.
inline glm::dmat4 turn_y(double degrees) {
  const glm::dvec2 c = circle(degrees);
  glm::dmat4 m(1.0);
  m[0] = {c.x, 0.0, -c.y, 0.0};
  m[2] = {c.y, 0.0, c.x, 0.0};
  return m;
}

inline glm::dmat4 turn_x(double degrees) {
  const glm::dvec2 c = circle(degrees);
  glm::dmat4 m(1.0);
  m[1] = {0.0, c.x, c.y, 0.0};
  m[2] = {0.0, -c.y, c.x, 0.0};
  return m;
}

inline glm::dmat4 turn_z(double degrees) {
  const glm::dvec2 c = circle(degrees);
  glm::dmat4 m(1.0);
  m[0] = {c.x, c.y, 0.0, 0.0};
  m[1] = {-c.y, c.x, 0.0, 0.0};
  return m;
}

inline glm::dmat4 move(const glm::dvec3& by) {
  glm::dmat4 m(1.0);
  m[3] = glm::dvec4(by, 1.0);
  return m;
}

inline glm::dmat4 stretch(const glm::dvec3& by) {
  glm::dmat4 m(1.0);
  m[0].x = by.x;
  m[1].y = by.y;
  m[2].z = by.z;
  return m;
}

}  // namespace penumbra::scenes
