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

namespace {

/// Perlin's quintic: no visible creases at lattice lines.
double fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

int wrapped(double floor, int period) {
  const auto i = static_cast<std::int64_t>(floor) % period;
  return static_cast<int>(i < 0 ? i + period : i);
}

}  // namespace

FractalNoise::FractalNoise(int cells_x, int cells_y, int octaves, std::uint32_t seed) {
  double weight = 1.0;
  for (int octave = 0; octave < octaves; ++octave) {
    Octave lattice_of{cells_x, cells_y, weight, {}};
    for (int y = 0; y < cells_y; ++y)
      for (int x = 0; x < cells_x; ++x)
        lattice_of.values.push_back(
            lattice(x, y, seed + 101u * static_cast<std::uint32_t>(octave)));
    lattices.push_back(std::move(lattice_of));
    total += weight;
    weight *= 0.5;
    cells_x *= 2;
    cells_y *= 2;
  }
}

double FractalNoise::operator()(double u, double v) const {
  double sum = 0.0;
  for (const Octave& octave : lattices) {
    const double x = u * octave.cells_x, y = v * octave.cells_y;
    const double floor_x = std::floor(x), floor_y = std::floor(y);
    const int x0 = wrapped(floor_x, octave.cells_x), y0 = wrapped(floor_y, octave.cells_y);
    const int x1 = x0 + 1 == octave.cells_x ? 0 : x0 + 1,
              y1 = y0 + 1 == octave.cells_y ? 0 : y0 + 1;
    const double* row0 =
        &octave.values[static_cast<std::size_t>(y0) * static_cast<std::size_t>(octave.cells_x)];
    const double* row1 =
        &octave.values[static_cast<std::size_t>(y1) * static_cast<std::size_t>(octave.cells_x)];
    const double sx = fade(x - floor_x), sy = fade(y - floor_y);
    const double low = row0[x0] * (1.0 - sx) + row0[x1] * sx;
    const double high = row1[x0] * (1.0 - sx) + row1[x1] * sx;
    sum += octave.weight * (low * (1.0 - sy) + high * sy);
  }
  return sum / total;
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace penumbra::scenes
