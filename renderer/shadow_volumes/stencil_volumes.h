#pragma once

#include "renderer/frame/prepare_context.h"

namespace penumbra::shadow_volumes {

/// Which crossings of a volume's surface along the view ray are counted.
enum class Counting {
  behind,  ///< z-fail: those behind the visible surface. Right wherever the camera stands
  before,  ///< z-pass: those between camera and surface. Wrong when the camera is in a volume
};

/// Parameters of every technique that counts volumes: clamp.
std::vector<Parameter> volume_parameters();

/// The count of volumes as a picture, from picture_of_count.
Diagnostic count_diagnostic();

struct VolumeOptions {
  Counting counting = Counting::behind;
  /// Three sides for every lit triangle instead of silhouettes: needs no adjacency.
  bool every_edge = false;
  /// Leave out casters that provably cannot shadow anything visible, and end volumes behind
  /// everything that is.
  bool clamp = false;
  /// Decide by the sides' own planes, not by the rasteriser's depths, whether they are crossed
  /// behind the surface, as penumbra wedges decide it. Only for Counting::behind.
  bool exact_sides = false;
  /// Of the light, where not only its centre throws the shadows that clamping must keep: m, or the
  /// tangent of the angle when directional.
  double light_radius = 0.0;
};

/// Shadow volumes from the centre of a light, counted in the geometry buffer's stencil: 0 where the
/// light arrives. What all volume techniques are composed from. Needs stencil and adjacency.
class StencilVolumes {
 public:
  /// Clears the stencil and draws the volumes of all casters, in a pass named "volumes".
  void draw(PrepareContext& context, const VolumeOptions& options);

  /// Names for renderer/shadow_volumes/read_stencil.glsl: "volume_count".
  void bind(vulkan::Bindings& bindings) const;

 private:
  const vulkan::Image* stencil_ = nullptr;
};

}  // namespace penumbra::shadow_volumes
