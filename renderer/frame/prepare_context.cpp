#include "renderer/frame/prepare_context.h"

#include "renderer/scene/convex_clip.h"

namespace penumbra {
namespace {

/// Triangles that are drawn at once.
struct CasterDraw {
  const DrawRange& range;  ///< the first
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
};

/// Neighbours that are drawn alike become one; opaque ones whatever their material.
void add_draw(std::vector<CasterDraw>& draws, const CasterDraw& draw) {
  if (draw.count == 0) return;
  if (!draws.empty()) {
    CasterDraw& last = draws.back();
    const bool alike = last.cull == draw.cull && last.range.masked == draw.range.masked &&
                       (!draw.range.masked || last.range.material == draw.range.material);
    if (alike && last.first + last.count == draw.first) {
      last.count += draw.count;
      return;
    }
  }
  draws.push_back(draw);
}

/// By more than places and boxes lose as floats: a light in the plane of a face is not outside.
Bounds widened(const Bounds& box) {
  const glm::dvec3 most = glm::max(glm::abs(box.low), glm::abs(box.high));
  const double margin = 1e-5 * glm::length(box.size()) + 1e-6 * glm::length(most);
  return {box.low - margin, box.high + margin};
}

}  // namespace

DrawnCasters PrepareContext::draw_casters(vulkan::Commands& commands, const CasterProgram& program,
                                          const vulkan::Bindings& bindings,
                                          const glm::mat4& clip_from_world) {
  vulkan::GraphicsState state = program.state;
  const auto pipeline_for = [&](bool masked) -> const vulkan::Pipeline& {
    vulkan::ProgramSource source{program.stages, program.preamble};
    if (masked) source.preamble += "#define MASKED\n";
    if (!masked && program.shades_holes_alone) source.stages.erase(VK_SHADER_STAGE_FRAGMENT_BIT);
    state.vertex_input = masked ? vulkan::VertexInput::surface : vulkan::VertexInput::position;
    return pipelines.graphics(source, state);
  };
  vulkan::Bindings all = frame_bindings;
  all.add(bindings);
  const VkBuffer buffers[] = {scene.position_buffer().handle(), scene.surface_buffer().handle()};
  const VkDeviceSize offsets[] = {0, 0};
  vkCmdBindVertexBuffers(commands.handle(), 0, 2, buffers, offsets);
  vkCmdBindIndexBuffer(commands.handle(), scene.index_buffer().handle(), 0, VK_INDEX_TYPE_UINT32);

  const auto& ranges = scene.ranges();
  const auto sides = side_planes(glm::dmat4(clip_from_world));
  const auto drawn = [&](const DrawRange& range) {
    if (!range.casts_shadow && !program.all_surfaces) return false;
    const Bounds box = range.box();
    if (!program.cull_by_spheres) return may_touch(box, sides);
    return may_touch(box.center(), 0.5 * glm::length(box.size()), sides);
  };
  DrawnCasters counted;
  std::vector<CasterDraw> draws;
  for (const DrawRange& range : ranges) {
    if (!drawn(range)) continue;
    counted.triangles += range.index_count / 3;
    ++counted.ranges;
    const VkCullModeFlags cull =
        range.double_sided ? VkCullModeFlags{VK_CULL_MODE_NONE} : program.cull;
    const bool from_outside = !light.is_within(widened(range.body));
    const std::uint32_t closed =
        program.first_surface_alone && from_outside ? range.closed_count : 0;
    add_draw(draws, {range, range.first_index, closed, VK_CULL_MODE_BACK_BIT});
    add_draw(draws, {range, range.first_index + closed, range.index_count - closed, cull});
  }
  for (const CasterDraw& draw : draws) {
    if (draw.range.masked)
      all.texture("surface_texture", scene.texture_of(draw.range.material),
                  vulkan::Sampling::linear_repeat);
    commands.bind(pipeline_for(draw.range.masked), all);
    if (draw.range.masked) commands.constants(draw.range.material);
    commands.cull(draw.cull);
    vkCmdDrawIndexed(commands.handle(), draw.count, 1, draw.first, 0, 0);
  }
  return counted;
}

}  // namespace penumbra
