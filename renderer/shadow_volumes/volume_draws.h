#pragma once

#include <set>

#include "renderer/frame/prepare_context.h"

namespace penumbra::shadow_volumes {

/// VolumeBlock of facing.glsl.
struct VolumeConstants {
  glm::vec4 end_plane{0.0f};
  float reach = 0.0f;
  std::uint32_t every_triangle = 0;
  float far_depth = 0.0f;
};

/// The casters whose volumes are to be drawn, in as few draws as may be.
struct VolumeDraws {
  struct Draw {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    VolumeConstants constants;
  };
  std::vector<Draw> draws;
  const vulkan::Buffer* indices = nullptr;

  /// Binds vertices and indices and draws all; a pipeline must be bound.
  void record(vulkan::Commands& commands, const GpuScene& scene) const;
  /// Draws the triangles of open meshes as open_cap.vert wants them, with `constants` where the
  /// bound pipeline reads any.
  void record_open_caps(vulkan::Commands& commands, bool constants) const;
  bool any_open() const;
};

struct VolumeDrawOptions {
  /// Plain triangles instead of ones with adjacency.
  bool every_edge = false;
  /// Leave out casters that cannot shadow anything visible, and end volumes behind everything that
  /// is.
  bool clamp = false;
  /// Instances that are left out.
  std::set<std::uint32_t> hidden;
  /// Instances whose triangles each count as a sheet.
  std::set<std::uint32_t> as_sheets;
  /// Take all meshes for closed ones.
  bool gaps_ignored = false;
  /// Radius of the sphere around the light from which shadows are thrown, m (tangent of the angle
  /// when directional).
  double light_radius = 0.0;
  /// Casters that are drawn, by their box; all where this is empty.
  std::function<bool(const glm::vec3& low, const glm::vec3& high)> accept;
};

VolumeDraws list_volume_draws(const PrepareContext& context, const VolumeDrawOptions& options);

/// Names that open_cap.vert reads.
void bind_corners(vulkan::Bindings& bindings, const PrepareContext& context);

/// Program stages and topology that all volumes begin with.
vulkan::ProgramSource volume_program(const std::string& geometry_shader, bool every_edge);
VkPrimitiveTopology volume_topology(bool every_edge);

}  // namespace penumbra::shadow_volumes
