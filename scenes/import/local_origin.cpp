#include "scenes/import/local_origin.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra::scenes {
namespace {

/// A mesh farther away than so many times its width is counted from a place of its own: a float
/// then keeps a millionth of the width or less (16 / 2^24).
constexpr double far_widths = 16.0;

/// Points looked at: more would change quartiles little.
constexpr std::size_t most_samples = 16384;

}  // namespace

glm::dvec3 local_origin(std::span<const glm::dvec3> points) {
  if (points.empty()) return glm::dvec3(0.0);
  const std::size_t step = (points.size() + most_samples - 1) / most_samples;
  glm::dvec3 middle(0.0);
  double width = 0.0, extent = 0.0;
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t i = 0; i < points.size(); i += step) values.push_back(points[i][axis]);
    std::sort(values.begin(), values.end());
    middle[axis] = values[values.size() / 2];
    width = std::max(width, values[values.size() * 3 / 4] - values[values.size() / 4]);
    extent = std::max(extent, values.back() - values.front());
  }
  if (width == 0.0) width = extent;
  const double reach = far_widths * width;
  if (!(reach > 0.0) ||
      std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}) <= reach)
    return glm::dvec3(0.0);
  // A grid of powers of two, on which neighbours of a size find the same place.
  const double cell = std::exp2(std::ceil(std::log2(reach)));
  return glm::round(middle / cell) * cell;
}

}  // namespace penumbra::scenes
