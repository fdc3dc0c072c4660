#include "renderer/frame/scene_pass.h"

#include "renderer/scene/convex_clip.h"

namespace penumbra {

GeometryBuffer make_geometry_buffer(vulkan::Device& device, vulkan::MemoryLedger& ledger,
                                    std::uint32_t width, std::uint32_t height, bool stencil,
                                    bool emitted) {
  constexpr VkImageUsageFlags color =
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  const auto image = [&](const char* name, VkFormat format, VkImageUsageFlags usage) {
    vulkan::ImageDescription description;
    description.format = format;
    description.width = width;
    description.height = height;
    description.usage = usage;
    return vulkan::Image(device, ledger, name, description);
  };
  GeometryBuffer buffer;
  buffer.width = width;
  buffer.height = height;
  buffer.position = image("geometry positions", GeometryBuffer::position_format,
                          color | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  buffer.words = image("geometry surfaces", GeometryBuffer::words_format, color);
  buffer.depth = image(stencil ? "geometry depth and stencil" : "geometry depth",
                       stencil ? VK_FORMAT_D32_SFLOAT_S8_UINT : VK_FORMAT_D32_SFLOAT,
                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  if (emitted) buffer.emitted = image("emitted light", GeometryBuffer::emitted_format, color);
  return buffer;
}

namespace {

vulkan::RenderTargets targets_of(const GeometryBuffer& buffer) {
  vulkan::RenderTargets targets;
  targets.width = buffer.width;
  targets.height = buffer.height;
  for (const vulkan::Image* image : {&buffer.position, &buffer.words, &buffer.emitted})
    if (*image) targets.colors.push_back({image->slice(0), false, {}});
  targets.depth = buffer.depth.slice(0);
  targets.depth_format = buffer.depth.description().format;
  targets.clear_depth = true;
  targets.clear_stencil = true;
  return targets;
}

void draw_surfaces(vulkan::Commands& commands, vulkan::PipelineCache& pipelines,
                   const GpuScene& scene, const vulkan::GraphicsState& state,
                   vulkan::Bindings bindings, const glm::mat4& clip_from_world,
                   const GammaTreatment& gamma, const std::string& definitions) {
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/geometry_buffer.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shaders/geometry_buffer.frag"}};
  source.preamble = "#define DECODES " + std::to_string(gamma.decodes) + "\n";
  source.preamble += definitions;
  const auto program_of = [&](const DrawRange& range) {
    const bool textured = scene.scene().materials[range.material].texture >= 0;
    vulkan::ProgramSource program = source;
    if (textured || range.colored || range.masked) program.preamble += "#define COLOR_VARIES\n";
    if (textured) program.preamble += "#define TEXTURED\n";
    if (textured && gamma.textures_as_stored) program.preamble += "#define TEXTURES_AS_STORED\n";
    // A program that may discard is run before depth is tested: for masks alone.
    if (range.masked) program.preamble += "#define MASKED\n";
    return program;
  };
  const VkBuffer buffers[] = {scene.position_buffer().handle(), scene.surface_buffer().handle()};
  const VkDeviceSize offsets[] = {0, 0};
  vkCmdBindVertexBuffers(commands.handle(), 0, 2, buffers, offsets);
  vkCmdBindIndexBuffer(commands.handle(), scene.surface_index_buffer().handle(), 0,
                       VK_INDEX_TYPE_UINT32);

  // Neighbouring ranges of one material are drawn at once.
  const auto& ranges = scene.ranges();
  const auto sides = side_planes(glm::dmat4(clip_from_world));
  const auto visible = [&](const DrawRange& range) {
    return range.visible && may_touch(range.box(), sides);
  };
  for (std::size_t i = 0; i < ranges.size();) {
    const DrawRange& first = ranges[i];
    if (!visible(first)) {
      ++i;
      continue;
    }
    std::uint32_t count = first.index_count;
    std::size_t next = i + 1;
    while (next < ranges.size() && ranges[next].material == first.material &&
           ranges[next].masked == first.masked && ranges[next].colored == first.colored &&
           visible(ranges[next]))
      count += ranges[next++].index_count;
    if (scene.scene().materials[first.material].texture >= 0)
      bindings.texture("surface_texture", scene.texture_of(first.material),
                       vulkan::Sampling::linear_repeat);
    commands.bind(pipelines.graphics(program_of(first), state), bindings);
    commands.constants(first.material);
    commands.cull(first.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
    vkCmdDrawIndexed(commands.handle(), count, 1, first.first_index, 0, 0);
    i = next;
  }
}

/// Where no surface was drawn: together they cover everything. On lavapipe clearing takes longer.
void draw_background(vulkan::Commands& commands, vulkan::PipelineCache& pipelines,
                     const std::string& definitions, vulkan::GraphicsState state) {
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shaders/background.frag"}};
  source.preamble = definitions;
  state.vertex_input = vulkan::VertexInput::none;
  state.depth_compare = VK_COMPARE_OP_EQUAL;
  state.depth_write = false;
  commands.cull(VK_CULL_MODE_NONE);
  commands.bind(pipelines.graphics(source, state), {});
  commands.full_screen_triangle();
}

}  // namespace

void draw_geometry(vulkan::Commands& commands, vulkan::PipelineCache& pipelines,
                   const GpuScene& scene, const GeometryBuffer& buffer,
                   const vulkan::Bindings& frame_bindings, const glm::mat4& clip_from_world,
                   const GammaTreatment& gamma, bool marks_sky) {
  const vulkan::RenderTargets targets = targets_of(buffer);
  vulkan::GraphicsState state;
  state.color_formats = {GeometryBuffer::position_format, GeometryBuffer::words_format};
  if (buffer.emitted) state.color_formats.push_back(GeometryBuffer::emitted_format);
  state.depth_format = targets.depth_format;
  state.depth_test = state.depth_write = true;
  state.depth_compare = VK_COMPARE_OP_GREATER;
  state.vertex_input = vulkan::VertexInput::surface;
  const std::string definitions = buffer.emitted ? "#define EMISSIVE\n" : "";
  commands.begin_rendering(targets);
  draw_surfaces(commands, pipelines, scene, state, frame_bindings, clip_from_world, gamma,
                definitions);
  if (marks_sky) draw_background(commands, pipelines, definitions, state);
  commands.end_rendering();
}

}  // namespace penumbra
