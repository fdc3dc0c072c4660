#pragma once

#include "renderer/frame/gpu_scene.h"
#include "renderer/reference/hierarchy.h"
#include "renderer/vulkan/texel_view.h"

namespace penumbra::reference {

/// The casters of a scene on the device, ready to be walked: built once per scene and kept with it.
/// Their lengths are times GpuScene::inverse_size.
class Intersector {
 public:
  static constexpr const char* requirement = acceleration_structure_name;

  Intersector(vulkan::Device& device, const GpuScene& scene);

  /// The one of this scene, built when first asked for. Its memory is charged to a technique by
  /// Requirements::acceleration_structure.
  static const Intersector& of(vulkan::Device& device, const GpuScene& scene);

  std::uint32_t node_count() const { return node_count_; }
  bool has_holes() const { return has_holes_; }  ///< some casters are alpha-masked
  const std::vector<ResourceCost>& memory() const { return ledger_.entries; }
  /// What renderer/reference/intersector.glsl reads.
  void bind(vulkan::Bindings& bindings) const;

 private:
  vulkan::TexelBuffer make(vulkan::Device& device, const std::string& name, const void* data,
                           std::size_t bytes, VkFormat format, std::size_t texel_bytes);

  vulkan::MemoryLedger ledger_;
  std::uint32_t node_count_ = 0;
  bool has_holes_ = false;
  vulkan::TexelBuffer nodes_, triangles_, hole_triangles_, hole_alphas_;
};

}  // namespace penumbra::reference
