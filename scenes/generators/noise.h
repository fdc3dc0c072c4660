#pragma once

#include <cstdint>

namespace penumbra::scenes {

/// Seeded noise that repeats and uses exact arithmetic only (no library functions), so that the
/// same seed gives the same texels on every machine.

/// Random value in [0, 1) of a lattice point.
double lattice(std::int64_t x, std::int64_t y, std::uint32_t seed);

/// Smooth value noise in [0, 1); repeats every `period_x`, `period_y` units.
double value_noise(double x, double y, int period_x, int period_y, std::uint32_t seed);

/// Sum of `octaves` of value noise, each twice as fine and half as strong, in [0, 1). u and v in
/// [0, 1) span one repeat, which holds `cells_x` by `cells_y` lattice cells of the coarsest octave.
double fractal_noise(double u, double v, int cells_x, int cells_y, int octaves, std::uint32_t seed);

/// 0 below `low`, 1 above `high`, smooth in between.
double smooth_step(double low, double high, double x);

}  // namespace penumbra::scenes
