#pragma once

#include "renderer/shadow_volumes/coverage_table.h"
#include "renderer/shadow_volumes/stencil_volumes.h"

namespace penumbra::shadow_volumes {

struct SoftVolumeOptions {
  VkFormat format = VK_FORMAT_R32_SFLOAT;  ///< one float: wedges add up in an image of it
  std::uint32_t table_size = 64;           ///< places along each axis of the coverage table
  bool count_overlaps = false;             ///< also count volumes at points of the light
  bool clamp = false;                      ///< as VolumeOptions
};

/// Penumbra wedges over hard volumes: the stencil holds how many volumes hide the light's centre,
/// and a second image by what part of the light that is too much or too little. Needs stencil and
/// adjacency. A light without extent is a hard volume and nothing more.
class SoftVolumes {
 public:
  /// Draws passes "volumes" and, for a light with an extent, "wedges".
  void draw(PrepareContext& context, const SoftVolumeOptions& options);

  /// Names for techniques/soft-shadow-volumes/shadow.glsl: "volume_count", "wedge_coverage",
  /// "first_counts" and "second_counts".
  void bind(vulkan::Bindings& bindings) const;

 private:
  void create(PrepareContext& context, const SoftVolumeOptions& options);
  void draw_wedges(PrepareContext& context, bool clamp);

  StencilVolumes volumes_;
  vulkan::Image coverage_;
  vulkan::Buffer table_;
  vulkan::Image counts_[2];
  const vulkan::Image* unused_ = nullptr;  ///< bound in place of images that are not made
};

}  // namespace penumbra::shadow_volumes
