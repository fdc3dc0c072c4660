#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::experiments {

/// Real time is 20 frames a second (van Sambeek 2007, 4.2.1).
inline constexpr double real_time_ms = 50.0;

/// Times of one technique and triangle count under three lights.
struct TimeGrid {
  struct Point {
    int objects;
    double pixels;  ///< along an edge
    double ms;
    double fragments;
  };
  std::vector<Point> points;
};

/// Points of the rows that are done: `name`, sweep:Ox`triangles`x`lights`.
TimeGrid time_grid(const std::vector<nlohmann::json>& rows, const std::string& name, int triangles,
                   int lights);

/// Limits as in table 4.1.
struct Limits {
  int objects = 0;        ///< most of the measured ones that stay under 50 ms at any size; 0: none
  double size = 0.0;      ///< the largest size where they do, pixels
  double at_largest = 0;  ///< objects at the largest measured size, linear between measured ones
  double largest = 0.0;   ///< that size
  bool beyond = false;    ///< the most objects measured still pass there: at_largest is a bound
};
std::optional<Limits> limits_of(const TimeGrid& grid);

/// How a time grows: the exponent of a power law, from least squares over logarithms, over the
/// upper half of what was measured.
struct Growth {
  double over_pixels = 0.0;   ///< of the picture's area, at the most objects
  double over_objects = 0.0;  ///< at the largest size
  /// More fragments for every pixel more, from the smallest to the largest size at the most
  /// objects: what maps of a fixed size draw is not in it.
  double fragments_per_pixel = 0.0;
};
std::optional<Growth> growth_of(const TimeGrid& grid);

/// "fill rate" where more than 8 fragments are drawn for every pixel than the same frame has
/// without shadows, "geometry" where time grows with objects and hardly (exponent below 0.25) with
/// pixels, otherwise "shaders".
std::string bottleneck_of(const Growth& growth, const Growth& none);

/// Slope of log(y) over log(x); nothing for fewer than two different x or values that are not
/// positive.
std::optional<double> exponent(const std::vector<std::pair<double, double>>& points);

/// Pairs whose order two lists of values agree on, and pairs that both tell apart.
struct Agreement {
  std::size_t agreeing = 0;
  std::size_t pairs = 0;
};
Agreement agreement(const std::vector<double>& ours, const std::vector<double>& theirs);

}  // namespace penumbra::experiments
