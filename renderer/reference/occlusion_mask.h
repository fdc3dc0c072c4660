#pragma once

#include "renderer/frame/prepare_context.h"
#include "renderer/frame/sample_list.h"
#include "renderer/reference/intersector.h"
#include "renderer/reference/sample_classes.h"

namespace penumbra::reference {

/// How far a receiver may lie from its facet, per metre of its coordinates and of its distance from
/// the camera, where that is within the scene: what rounding of interpolated positions moves them
/// by, several times over. Triangles whose planes are that near hide nothing from it.
constexpr float receiver_rounding = 1e-6f;

/// That distance, m, of a point of the renderer's world space. As receiver.glsl has it.
float rounding_of(const GpuScene& scene, const glm::vec3& position,
                  const glm::vec3& camera_position);

/// For every sample of the frame and every light point of a batch: is the segment between them (or
/// the ray towards a directional light) cut by a caster? One bit each; exact up to float rounding.
class OcclusionMask {
 public:
  /// Rounds of loops that a sample's walk may take in one dispatch; then another one resumes it.
  /// Eight lanes that run in step wait for one another, and some drivers end loops after 65,535
  /// rounds.
  static constexpr std::uint32_t default_rounds = 7500;

  /// `rounds`: 2 at least.
  explicit OcclusionMask(std::uint32_t rounds = default_rounds) : rounds_(rounds) {}

  /// Records the passes for the context's batch. The first of several batches also proves samples
  /// fully lit or fully dark, and finds for the others where in the hierarchy there is anything
  /// that may hide any part of the light.
  void trace(PrepareContext& context);

  /// What renderer/reference/occlusion_mask.glsl reads.
  void bind(vulkan::Bindings& bindings) const;

  const vulkan::Buffer& masks() const { return masks_.buffer; }  ///< words, samples of the frame

  /// Samples that part or all of the light reaches, where there are several batches.
  const SampleList* lit_samples() const { return lit_.ranges.empty() ? nullptr : &lit_; }

 private:
  using Ranges = std::vector<SampleList::Range>;  ///< one of each place in a pixel
  struct Program {
    const char* file;
    std::string defines;
  };
  /// What programs read of a batch, for each place in a pixel.
  struct BatchData {
    std::vector<vulkan::BufferRange> shafts, points, boxes;
  };

  void create_masks(PrepareContext& context);
  void create_lists(PrepareContext& context);
  static BatchData push_batch(PrepareContext& context);
  void find_samples(PrepareContext& context, const BatchData& data);
  void sort_samples(PrepareContext& context, const SampleClasses& classes);
  void list_occluders(PrepareContext& context, const BatchData& data, const SampleClasses& classes);
  void test_listed(PrepareContext& context, const BatchData& data);
  vulkan::Bindings own_bindings(const PrepareContext& context) const;
  /// Runs a program that walks the hierarchy, at the ranges of a list or at all samples, until all
  /// walks have ended.
  void walk(PrepareContext& context, const std::string& name, Program program,
            const BatchData& data, const Ranges* ranges);
  bool are_walks_long(const PrepareContext& context) const;
  std::uint32_t unfinished(PrepareContext& context) const;

  std::uint32_t rounds_;
  vulkan::TexelBuffer masks_;
  vulkan::Image candidates_;   ///< two layers: first node and end of what may hide any of the light
  vulkan::Image walk_places_;  ///< nodes where long walks are to be resumed
  vulkan::Buffer faults_;      ///< as faults.glsl has it: long walks to be resumed
  SampleList lit_;             ///< by class
  vulkan::Buffer class_counts_;  ///< samples, by place in the pixel and class
  vulkan::Buffer found_;         ///< a copy, to read
  Ranges listed_, walked_;       ///< samples in penumbrae, with and without a list of occluders
  std::vector<SampleClasses::Chunk> chunks_;  ///< of those with one
  vulkan::TexelBuffer lists_, occluders_;     ///< as occluder_lists.glsl has them
  vulkan::Buffer list_counters_;              ///< as list_occluders.comp has them
  vulkan::TexelBuffer pairs_;                 ///< as occluder_pairs.glsl has it
};

}  // namespace penumbra::reference
