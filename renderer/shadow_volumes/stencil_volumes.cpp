#include "renderer/shadow_volumes/stencil_volumes.h"

#include "renderer/shadow_volumes/volume_bounds.h"

namespace penumbra::shadow_volumes {
namespace {

/// VolumeBlock of facing.glsl.
struct VolumeConstants {
  glm::vec4 end_plane{0.0f};
  float reach = 0.0f;
  std::uint32_t every_triangle = 0;
};

vulkan::GraphicsState stencil_state(const PrepareContext& context, const VolumeOptions& options) {
  vulkan::GraphicsState state;
  state.depth_format = context.geometry.depth.description().format;
  state.vertex_input = vulkan::VertexInput::position;
  state.topology = options.every_edge ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
                                      : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY;
  state.depth_test = true;
  // A crossing at the very depth of the surface counts as behind it.
  state.depth_compare = VK_COMPARE_OP_GREATER;
  // A perspective view has its far plane at infinity and needs no clamp; without one, triangles are
  // clipped just as they were when the depth was drawn. A parallel view ends somewhere.
  state.depth_clamp = context.input.camera.projection == Projection::orthographic;
  state.stencil_test = true;
  if (options.counting == Counting::behind) {
    state.stencil_front.depth_fail = VK_STENCIL_OP_DECREMENT_AND_WRAP;
    state.stencil_back.depth_fail = VK_STENCIL_OP_INCREMENT_AND_WRAP;
  } else {
    state.stencil_front.pass = VK_STENCIL_OP_INCREMENT_AND_WRAP;
    state.stencil_back.pass = VK_STENCIL_OP_DECREMENT_AND_WRAP;
  }
  return state;
}

struct VolumeDraw {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  VolumeConstants constants;
};

/// Casters in as few draws as may be: neighbours drawn alike become one.
std::vector<VolumeDraw> list_draws(const PrepareContext& context, const VolumeOptions& options) {
  const VolumeBounds bounds(context);
  const float reach = 1e4f * glm::length(context.scene.high() - context.scene.low());
  std::vector<VolumeDraw> draws;
  const auto add = [&](const auto& part, bool every_triangle) {
    if (!part.casts_shadow) return;
    VolumeDraw draw{
        part.first_index, part.index_count, {glm::vec4(0.0f), reach, every_triangle ? 1u : 0u}};
    if (options.clamp) {
      if (!bounds.may_shadow(part.low, part.high)) return;
      draw.constants.end_plane = bounds.end_plane(part.low, part.high).value_or(glm::vec4(0.0f));
    }
    if (!draws.empty()) {
      VolumeDraw& last = draws.back();
      if (last.first_index + last.index_count == draw.first_index &&
          last.constants.every_triangle == draw.constants.every_triangle &&
          last.constants.end_plane == draw.constants.end_plane) {
        last.index_count += draw.index_count;
        return;
      }
    }
    draws.push_back(draw);
  };
  if (options.every_edge)
    for (const DrawRange& range : context.scene.ranges()) add(range, false);
  else
    for (const AdjacencyGroup& group : context.adjacency->host.groups) add(group, !group.closed);
  return draws;
}

void note_ignored_masks(PrepareContext& context) {
  for (const DrawRange& range : context.scene.ranges())
    if (range.masked && range.casts_shadow) {
      context.notes.push_back(
          "shadow volumes ignore alpha masks: masked casters cast the shadows of whole triangles");
      return;
    }
}

}  // namespace

std::vector<Parameter> volume_parameters() {
  Parameter clamp;
  clamp.name = "clamp";
  clamp.type = ParameterType::boolean;
  clamp.default_value = false;
  clamp.meaning =
      "Culls casters that cannot shadow anything visible and ends volumes behind the last visible "
      "surface instead of at infinity.";
  return {clamp};
}

Diagnostic count_diagnostic() {
  return {"count",
          "Volumes that each sample lies in: grey none, yellow to red one to 32 and more, blue a "
          "count that fell below nought."};
}

void StencilVolumes::draw(PrepareContext& context, const VolumeOptions& options) {
  stencil_ = &context.geometry.depth;
  note_ignored_masks(context);
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shadow_volumes/volume.vert"},
                   {VK_SHADER_STAGE_GEOMETRY_BIT, "renderer/shadow_volumes/volume.geom"}};
  if (options.counting == Counting::behind) source.preamble += "#define WITH_CAPS\n";
  if (options.every_edge) source.preamble += "#define EVERY_EDGE\n";
  const vulkan::Pipeline& pipeline =
      context.pipelines.graphics(source, stencil_state(context, options));

  vulkan::RenderTargets targets;
  targets.width = context.geometry.width;
  targets.height = context.geometry.height;
  targets.depth = context.geometry.depth.slice(0);
  targets.depth_format = context.geometry.depth.description().format;
  targets.clear_stencil = true;
  const std::vector<VolumeDraw> draws = list_draws(context, options);
  const vulkan::Buffer& indices =
      options.every_edge ? context.scene.index_buffer() : context.adjacency->indices;
  context.pass("volumes", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    commands.bind(pipeline, context.frame_bindings);
    const VkBuffer buffer = context.scene.position_buffer().handle();
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(commands.handle(), 0, 1, &buffer, &offset);
    vkCmdBindIndexBuffer(commands.handle(), indices.handle(), 0, VK_INDEX_TYPE_UINT32);
    for (const VolumeDraw& draw : draws) {
      commands.constants(draw.constants);
      vkCmdDrawIndexed(commands.handle(), draw.index_count, 1, draw.first_index, 0, 0);
    }
    commands.end_rendering();
  });
}

void StencilVolumes::bind(vulkan::Bindings& bindings) const {
  bindings.stencil("volume_count", *stencil_);
}

}  // namespace penumbra::shadow_volumes
