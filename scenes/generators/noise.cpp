#include "scenes/generators/noise.h"

#include <algorithm>
#include <cmath>

namespace penumbra::scenes {

double lattice(std::int64_t x, std::int64_t y, std::uint32_t seed) {
  // splitmix64's finaliser over the packed coordinates.
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ull ^
                    static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Full ^
                    (std::uint64_t{seed} << 32 | 0x5bd1e995u);
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
  h ^= h >> 31;
  return static_cast<double>(h >> 11) * 0x1p-53;
}

double value_noise(double x, double y, int period_x, int period_y, std::uint32_t seed) {
  const double floor_x = std::floor(x), floor_y = std::floor(y);
  const double fx = x - floor_x, fy = y - floor_y;
  const auto wrap = [](std::int64_t i, int period) { return ((i % period) + period) % period; };
  const auto ix = static_cast<std::int64_t>(floor_x), iy = static_cast<std::int64_t>(floor_y);
  const std::int64_t x0 = wrap(ix, period_x), x1 = wrap(ix + 1, period_x);
  const std::int64_t y0 = wrap(iy, period_y), y1 = wrap(iy + 1, period_y);
  // Perlin's quintic: no visible creases at lattice lines.
  const double sx = fx * fx * fx * (fx * (fx * 6.0 - 15.0) + 10.0);
  const double sy = fy * fy * fy * (fy * (fy * 6.0 - 15.0) + 10.0);
  const double low = lattice(x0, y0, seed) * (1.0 - sx) + lattice(x1, y0, seed) * sx;
  const double high = lattice(x0, y1, seed) * (1.0 - sx) + lattice(x1, y1, seed) * sx;
  return low * (1.0 - sy) + high * sy;
}

double fractal_noise(double u, double v, int cells_x, int cells_y, int octaves,
                     std::uint32_t seed) {
  double sum = 0.0, weight = 1.0, total = 0.0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * value_noise(u * cells_x, v * cells_y, cells_x, cells_y,
                                seed + 101u * static_cast<std::uint32_t>(octave));
    total += weight;
    weight *= 0.5;
    cells_x *= 2;
    cells_y *= 2;
  }
  return sum / total;
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace penumbra::scenes
