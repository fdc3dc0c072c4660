#pragma once

#include <cstddef>
#include <vector>

namespace penumbra {

/// Decides from the times of equal pieces of work that follow each other when they can be trusted.
/// A GPU that idles for some tenths of a second lowers its clocks, and raises them in steps once it
/// is busy. Seen on an H200 after a second's rest: frames take 5.7 times as long for 0.15 s,
/// sometimes 3 times as long for another 0.2 s, all with a small spread, and are steady after
/// 0.34 s at the latest.
class SteadyTimes {
 public:
  static constexpr double least_busy_ms = 600.0;  ///< device time before times are believed
  static constexpr double most_wall_ms = 3000.0;  ///< wall time after which to stop waiting
  static constexpr double batch_ms = 150.0;       ///< device time that a median is taken over
  static constexpr double tolerance = 0.01;       ///< between two successive medians, relative
  static constexpr std::size_t few = 3;           ///< pieces as fast as the fastest are enough

  /// `best_ms`: what a piece takes when clocks are up; 0 where that is not known.
  explicit SteadyTimes(double best_ms = 0.0) : best_ms_(best_ms) {}

  /// Takes a piece: device time, and wall time with all that the CPU did between.
  void add(double device_ms, double wall_ms);

  /// The last few are as fast as the fastest; where none is known, the device was busy long enough
  /// and the medians of the last two batches agree.
  bool steady() const;

  /// It has waited as long as is worth it.
  bool given_up() const { return wall_ms_ >= most_wall_ms && times_.size() >= 2; }

  /// Median of the last few pieces, device time.
  double last_ms() const;

 private:
  /// The first of the pieces before `end` that together took batch_ms, or the first of all.
  std::size_t batch_before(std::size_t end) const;
  double median(std::size_t begin, std::size_t end) const;

  double best_ms_;
  std::vector<double> times_;  ///< device times, ms
  double busy_ms_ = 0.0;
  double wall_ms_ = 0.0;
};

}  // namespace penumbra
