#pragma once

#include <optional>
#include <set>

#include "renderer/shadow_volumes/crowding.h"
#include "renderer/shadow_volumes/deep_counts.h"

namespace penumbra::shadow_volumes {

class NearPlane;
struct VolumeDraws;
struct VolumeDrawOptions;

/// Which crossings of a volume's surface along the view ray are counted.
enum class Counting {
  behind,  ///< z-fail: those behind the visible surface. Right wherever the camera stands
  before,  ///< z-pass: those between camera and surface. Wrong when the camera is in a volume
};

/// A precaution that is left out, to show what it is for.
enum class Ablation {
  none,
  far_clipped,   ///< volumes end at a far plane behind the last visible surface
  uncapped,      ///< volumes have sides only
  gaps_ignored,  ///< all meshes are taken for closed ones
  first_corner,  ///< triangles are turned to the light if their first corner is
};
Parameter ablation_parameter();

Parameter clamp_parameter();

/// Parameters of every technique that counts volumes: clamp, stencil_passes.
std::vector<Parameter> volume_parameters();

/// The count of volumes as a picture, from picture_of_count.
Diagnostic count_diagnostic();

/// Of the stencil, with VolumeOptions::masked; as count_masked_volumes in read_stencil.glsl has it.
constexpr std::uint32_t mask_bit = 0x80;

/// The largest count that the stencil holds.
constexpr std::uint32_t most_counted(bool masked) {
  return masked ? mask_bit - 1 : 0xff;
}

struct VolumeOptions {
  Counting counting = Counting::behind;
  /// Three sides for every lit triangle instead of silhouettes: needs no adjacency.
  bool every_edge = false;
  /// Leave out casters that provably cannot shadow anything visible or lie in another one's shadow,
  /// and end volumes behind everything that is visible.
  bool clamp = false;
  /// With Counting::before: count the volumes that the near plane lies in first, so that the count
  /// is right wherever the camera stands (z-pass+).
  bool near_caps = false;
  /// With Counting::behind: count before the surface those casters whose shadow cannot reach the
  /// near plane.
  bool automatic = false;
  /// 1: front and back faces in one pass by two-sided stencil; 2: a pass each.
  int stencil_passes = 1;
  /// Count only in samples whose stencil has mask_bit set, in the bits below it, and clear nothing.
  bool masked = false;
  /// Decide by the sides' own planes, not by the rasteriser's depths, whether they are crossed
  /// behind the surface, as penumbra wedges decide it. Only for Counting::behind.
  bool exact_sides = false;
  /// Only for Counting::behind.
  Ablation ablation = Ablation::none;
  /// Of the light, where not only its centre throws the shadows that clamping must keep: m, or the
  /// tangent of the angle when directional.
  double light_radius = 0.0;
};

/// Options that parameters of volume_parameters set.
VolumeOptions volume_options(const ParameterValues& parameters);

/// What throws the volumes that such options ask for.
VolumeTriangles volume_triangles(const PrepareContext& context, bool every_edge);

/// Shadow volumes from the centre of a light, counted in the geometry buffer's stencil: 0 where the
/// light arrives. Where more may overlap than the stencil counts, DeepCounts counts them first.
/// What all volume techniques are composed from. Needs stencil and adjacency.
class StencilVolumes {
 public:
  /// Clears the stencil and draws the volumes of all casters, in a pass named "volumes".
  void draw(PrepareContext& context, const VolumeOptions& options);

  /// Adds the number of fragments that draw would have to count, those that the mask lets through,
  /// to place `counter` of a buffer of 32-bit counts. Draws the volumes once more, in a pass named
  /// "count fragments", and changes nothing.
  void count_fragments(PrepareContext& context, const VolumeOptions& options,
                       vulkan::BufferRange counts, std::uint32_t counter);

  /// Names for renderer/shadow_volumes/read_stencil.glsl: "volume_count".
  void bind(vulkan::Bindings& bindings) const;

 private:
  struct Step;
  struct Counter;
  /// Which volumes options ask for.
  VolumeDrawOptions draws_wanted(const PrepareContext& context, const VolumeOptions& options);
  /// Whether more volumes may overlap than the stencil counts.
  bool is_deep(const PrepareContext& context, const VolumeOptions& options);
  /// Counts volumes, or with a counter the fragments that would.
  void add_steps(PrepareContext& context, const VolumeOptions& options, const VolumeDraws& draws,
                 std::vector<Step>& steps, const Counter* counter);
  void add_near_caps(PrepareContext& context, const VolumeOptions& options,
                     const NearPlane& near_plane, const VolumeDraws& draws,
                     std::vector<Step>& steps);

  const vulkan::Image* stencil_ = nullptr;
  std::optional<std::set<std::uint32_t>> hidden_;  ///< casters in the shadow of others, once sought
  std::optional<bool> deep_;                       ///< once sought
  DeepCounts counts_;
};

}  // namespace penumbra::shadow_volumes
