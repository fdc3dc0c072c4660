#pragma once

#include <cstddef>

#include "renderer/path_frame.h"

namespace penumbra::metrics {

/// How much visibility changes at fixed points of surfaces from one frame of a path to the next: by
/// as much as a point now lies outside of what the four samples around it had before. A shadow that
/// stays where it is changes nothing, wherever samples fall; one that moves by less than a pixel
/// may pass for that. A pixel counts where those four show its surface.
class FrameChange {
 public:
  /// The next frame of the path; all have one size and as many lights, otherwise bad_value.
  void add(PathFrame frame);

  std::size_t points() const { return points_; }  ///< compared, times lights, over all frames
  double mean_square() const;                     ///< of the change of visibility; 0 without points

 private:
  void compare(const PathFrame& before, const PathFrame& now);

  PathFrame last_;
  double sum_ = 0.0;
  std::size_t points_ = 0;
};

/// Change from frame to frame beyond the reference's own, as a root mean square of visibility: what
/// flickers or crawls though nothing but the camera moves. Both of the same path; 0 where the
/// technique changes no more than the reference.
double frame_difference(const FrameChange& technique, const FrameChange& reference);

}  // namespace penumbra::metrics
