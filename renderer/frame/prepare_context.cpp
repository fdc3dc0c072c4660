#include "renderer/frame/prepare_context.h"

#include "renderer/scene/convex_clip.h"

namespace penumbra {

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
  for (std::size_t i = 0; i < ranges.size();) {
    const DrawRange& first = ranges[i];
    if (!drawn(first)) {
      ++i;
      continue;
    }
    // Neighbouring ranges that are drawn alike become one draw; opaque ones whatever their
    // material.
    std::uint32_t count = first.index_count;
    std::size_t next = i + 1;
    while (next < ranges.size() && drawn(ranges[next]) && ranges[next].masked == first.masked &&
           ranges[next].double_sided == first.double_sided &&
           (!first.masked || ranges[next].material == first.material)) {
      count += ranges[next].index_count;
      ++next;
    }
    if (first.masked)
      all.texture("surface_texture", scene.texture_of(first.material),
                  vulkan::Sampling::linear_repeat);
    commands.bind(pipeline_for(first.masked), all);
    if (first.masked) commands.constants(first.material);
    commands.cull(first.double_sided ? VkCullModeFlags{VK_CULL_MODE_NONE} : program.cull);
    vkCmdDrawIndexed(commands.handle(), count, 1, first.first_index, 0, 0);
    counted.triangles += count / 3;
    counted.ranges += next - i;
    i = next;
  }
  return counted;
}

}  // namespace penumbra
