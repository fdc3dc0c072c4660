#include "renderer/shadow_volumes/volume_draws.h"

#include <algorithm>

#include "renderer/shadow_volumes/volume_bounds.h"
#include "renderer/vulkan/texel_view.h"

namespace penumbra::shadow_volumes {
namespace {

/// Corners of casters as a shader fetches them.
struct CornerViews {
  vulkan::Owned<VkBufferView> indices, positions;
};

const CornerViews& corner_views(const PrepareContext& context) {
  return context.scene.derived<CornerViews>([&] {
    auto views = std::make_shared<CornerViews>();
    views->indices =
        vulkan::texel_view(context.device, "neighbours of triangles", context.adjacency->indices,
                           VK_FORMAT_R32_UINT, sizeof(std::uint32_t));
    views->positions =
        vulkan::texel_view(context.device, "positions", context.scene.position_buffer(),
                           VK_FORMAT_R32_SFLOAT, sizeof(float));
    return views;
  });
}

}  // namespace

void VolumeDraws::record(vulkan::Commands& commands, const GpuScene& scene) const {
  const VkBuffer buffer = scene.position_buffer().handle();
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(commands.handle(), 0, 1, &buffer, &offset);
  vkCmdBindIndexBuffer(commands.handle(), indices->handle(), 0, VK_INDEX_TYPE_UINT32);
  for (const Draw& draw : draws) {
    commands.constants(draw.constants);
    vkCmdDrawIndexed(commands.handle(), draw.index_count, 1, draw.first_index, 0, 0);
  }
}

void VolumeDraws::record_open_caps(vulkan::Commands& commands, bool constants) const {
  for (const Draw& draw : draws) {
    if (draw.constants.every_triangle == 0u) continue;
    if (constants) commands.constants(draw.constants);
    // Six indices with adjacency hold the three corners of a triangle.
    vkCmdDraw(commands.handle(), draw.index_count / 2, 1, draw.first_index / 2, 0);
  }
}

bool VolumeDraws::any_open() const {
  return std::any_of(draws.begin(), draws.end(),
                     [](const Draw& draw) { return draw.constants.every_triangle != 0u; });
}

void bind_corners(vulkan::Bindings& bindings, const PrepareContext& context) {
  const CornerViews& views = corner_views(context);
  bindings.texel_buffer("adjacency_indices", views.indices);
  bindings.texel_buffer("caster_positions", views.positions);
}

VolumeDraws list_volume_draws(const PrepareContext& context, const VolumeDrawOptions& options) {
  const VolumeBounds bounds(context, options.light_radius);
  const float reach = 1e4f * glm::length(context.scene.high() - context.scene.low());
  const float far_depth = bounds.far_depth(context.camera.clip_from_world);
  VolumeDraws list;
  list.indices = options.every_edge ? &context.scene.index_buffer() : &context.adjacency->indices;
  const auto add = [&](const auto& part, bool every_triangle) {
    if (!part.casts_shadow || options.hidden.contains(part.instance)) return;
    if (options.accept && !options.accept(part.low, part.high)) return;
    VolumeDraws::Draw draw{part.first_index,
                           part.index_count,
                           {glm::vec4(0.0f), reach, every_triangle ? 1u : 0u, far_depth}};
    if (options.clamp) {
      if (!bounds.may_shadow(part.low, part.high)) return;
      draw.constants.end_plane = bounds.end_plane(part.low, part.high).value_or(glm::vec4(0.0f));
    }
    if (!list.draws.empty()) {
      VolumeDraws::Draw& last = list.draws.back();
      if (last.first_index + last.index_count == draw.first_index &&
          last.constants.every_triangle == draw.constants.every_triangle &&
          last.constants.end_plane == draw.constants.end_plane) {
        last.index_count += draw.index_count;
        return;
      }
    }
    list.draws.push_back(draw);
  };
  if (options.every_edge)
    for (const DrawRange& range : context.scene.ranges()) add(range, false);
  else
    for (const AdjacencyGroup& group : context.adjacency->host.groups)
      add(group,
          (!group.closed && !options.gaps_ignored) || options.as_sheets.contains(group.instance));
  return list;
}

vulkan::ProgramSource volume_program(const std::string& geometry_shader, bool every_edge) {
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shadow_volumes/volume.vert"},
                   {VK_SHADER_STAGE_GEOMETRY_BIT, geometry_shader}};
  if (every_edge) source.preamble = "#define EVERY_EDGE\n";
  return source;
}

VkPrimitiveTopology volume_topology(bool every_edge) {
  return every_edge ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
                    : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY;
}

}  // namespace penumbra::shadow_volumes
