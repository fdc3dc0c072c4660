#pragma once

#include "renderer/frame/prepare_context.h"
#include "renderer/frame/sample_list.h"
#include "renderer/reference/intersector.h"

namespace penumbra::reference {

/// How far a receiver may lie from its facet, per metre of its coordinates and of its distance from
/// the camera, where that is within the scene: what rounding of interpolated positions moves them
/// by, several times over. Triangles whose planes are that near hide nothing from it.
constexpr float receiver_rounding = 1e-6f;

/// That distance, m, of a point of the renderer's world space. As occlusion_mask.comp has it.
float rounding_of(const GpuScene& scene, const glm::vec3& position,
                  const glm::vec3& camera_position);

/// For every sample of the frame and every light point of a batch: is the segment between them (or
/// the ray towards a directional light) cut by a caster? One bit each; exact up to float rounding.
class OcclusionMask {
 public:
  /// Nodes that one dispatch walks at first: below the 65,535 rounds after which some drivers end
  /// loops, unless most are leaves that a sample must look at. Then half as many are, and so on.
  static constexpr std::uint32_t default_range = 45000;

  explicit OcclusionMask(std::uint32_t nodes_per_range = default_range)
      : nodes_per_range_(nodes_per_range) {}

  /// Records the passes for the context's batch. The first of several batches also proves samples
  /// fully lit or fully dark, and finds for the others where in the hierarchy there is anything
  /// that may hide any part of the light.
  void trace(PrepareContext& context);

  /// What renderer/reference/occlusion_mask.glsl reads.
  void bind(vulkan::Bindings& bindings) const;

  const vulkan::Image& image() const { return mask_; }  ///< R32_UINT, samples of the frame

  /// Samples that part or all of the light reaches, once there was a first of several batches.
  const SampleList* lit_samples() const { return lit_.texels ? &lit_ : nullptr; }

 private:
  void create(PrepareContext& context, bool many);
  void find_samples(PrepareContext& context);
  void list_occluders(PrepareContext& context);
  std::uint32_t found(std::uint32_t place) const;
  /// False where walks did not finish: the range is smaller then, and all is to be done again.
  [[nodiscard]] bool dispatch_sets(PrepareContext& context, const std::string& name,
                                   std::string defines,
                                   const std::vector<SampleList::Range>* ranges);
  bool may_end_early(const PrepareContext& context) const;
  bool finished(PrepareContext& context);
  void walk(const PrepareContext& context, vulkan::Commands& commands,
            const SampleList::Range* range, SampleWork work) const;

  std::uint32_t nodes_per_range_;
  vulkan::Image mask_;
  vulkan::Image candidates_;  ///< two layers: first node and end of what may hide any of the light
  SampleList lit_;
  std::vector<SampleList::Range> partly_lit_;  ///< the part of the list that rays are needed for
  vulkan::Buffer found_;                       ///< lengths of the lists, written by the device
  vulkan::Buffer faults_;                      ///< as faults.glsl has it
  vulkan::Buffer occluders_;                   ///< triangles for each sample of that part
  std::uint32_t occluder_limit_ = 0;           ///< most triangles of a sample; 0: none are listed
  std::uint32_t overflowed_ = 0;               ///< samples with more
};

}  // namespace penumbra::reference
