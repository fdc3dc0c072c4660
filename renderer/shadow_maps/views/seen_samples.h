#pragma once

#include "renderer/frame/prepare_context.h"
#include "renderer/shadow_maps/layout.h"

namespace penumbra::shadow_maps {

/// The float whose place in the order of all floats a shader wrote (float_places.glsl).
float float_at_place(std::uint32_t place);

/// What the camera sees, as points: a grid over the whole picture, whatever window of it is drawn,
/// so that all windows agree. Drawn once a frame, when first asked for. Bounds leave out surfaces
/// turned away from the light: no map is asked about them.
class SeenSamples {
 public:
  /// Most samples along a side of the grid; smaller pictures have one for each of theirs.
  static constexpr std::uint32_t most_side = 1024;

  /// What it allocates for a picture.
  static void require(const TechniqueInput& input, Requirements& needs);

  /// Another frame begins, whose samples are not drawn yet.
  void forget() { drawn_ = false; }

  /// Bounds of the samples that each view shows, along its own axes, m from its origin: x along
  /// right, y along up, z along forward. `by_depth`: of all samples whose depth before the camera
  /// lies within the view's choice.x and .y instead. Wider by what a surface may reach to the next
  /// sample. Empty where there are none. By depth reduction
  /// on the device and a read-back, for which the host waits.
  std::vector<Bounds> bounds(PrepareContext& context, const std::vector<shader::MapView>& views,
                             bool by_depth);

  /// Position, and how far the surface may reach to the next sample, m: negative where it is turned
  /// away from the light, 0 where there is none.
  const vulkan::Image& positions(PrepareContext& context);

 private:
  void draw(PrepareContext& context);

  vulkan::Image positions_;
  vulkan::Image depth_;
  vulkan::Buffer found_;
  bool drawn_ = false;
};

}  // namespace penumbra::shadow_maps
