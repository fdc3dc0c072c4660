#pragma once

#include "renderer/frame/prepare_context.h"

namespace penumbra::shadow_volumes {

/// Counts of volumes beyond what the stencil holds: the same volumes are drawn with the same tests,
/// and add their steps in an image of floats, which are exact up to 2^24.
class DeepCounts {
 public:
  /// Turns a program that counts in the stencil into one that adds to the image.
  static void redirect(vulkan::ProgramSource& source, vulkan::GraphicsState& state);

  /// The image as a cleared target; allocated when first asked for.
  vulkan::ColorTarget target(PrepareContext& context);

  /// Writes the counts to the stencil, as the volumes would have left them there had it more bits:
  /// a count that it cannot hold becomes the largest. `masked`: as VolumeOptions.
  void store(PrepareContext& context, bool masked) const;

 private:
  vulkan::Image counts_;
};

}  // namespace penumbra::shadow_volumes
