#pragma once

#include <cstdint>
#include <vector>

namespace penumbra::scenes {

/// Seeded noise that repeats and uses exact arithmetic only (no library functions), so that the
/// same seed gives the same texels on every machine.

/// Random value in [0, 1) of a lattice point.
double lattice(std::int64_t x, std::int64_t y, std::uint32_t seed);

/// Sum of `octaves` of smooth value noise, each twice as fine and half as strong, in [0, 1);
/// repeats every unit of u and v, which holds `cells_x` by `cells_y` lattice cells of the coarsest
/// octave.
class FractalNoise {
 public:
  FractalNoise(int cells_x, int cells_y, int octaves, std::uint32_t seed);
  double operator()(double u, double v) const;

 private:
  struct Octave {
    int cells_x, cells_y;
    double weight;
    std::vector<double> values;  ///< a row of cells_x per lattice line
  };
  std::vector<Octave> lattices;
  double total = 0.0;
};

/// 0 below `low`, 1 above `high`, smooth in between.
double smooth_step(double low, double high, double x);

}  // namespace penumbra::scenes
