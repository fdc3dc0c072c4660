#pragma once

#include "renderer/frame/prepare_context.h"
#include "renderer/reference/intersector.h"

namespace penumbra::reference {

/// For every sample of the frame and every light point of a batch: is the segment between them (or
/// the ray towards a directional light) cut by a caster? One bit each; exact up to float rounding.
/// Receivers start 2e-5 of the scene's diagonal above their facet.
class OcclusionMask {
 public:
  /// Nodes that one dispatch walks: far below the 65,535 rounds after which some drivers end loops.
  static constexpr std::uint32_t default_range = 45000;

  explicit OcclusionMask(std::uint32_t nodes_per_range = default_range)
      : nodes_per_range_(nodes_per_range) {}

  /// Records the passes for the context's batch. The first of several batches also finds, for every
  /// sample, where in the hierarchy there is anything that may hide any part of the light.
  void trace(PrepareContext& context);

  /// What renderer/reference/occlusion_mask.glsl reads.
  void bind(vulkan::Bindings& bindings) const;

  const vulkan::Image& image() const { return mask_; }  ///< R32_UINT, samples of the frame

 private:
  void create_images(PrepareContext& context, bool with_candidates);
  void dispatch(PrepareContext& context, const std::string& name, const std::string& preamble,
                bool has_candidates);

  std::uint32_t nodes_per_range_;
  vulkan::Image mask_;
  vulkan::Image candidates_;  ///< two layers: first node and end of what may hide any of the light
};

}  // namespace penumbra::reference
