#include "renderer/shadow_maps/views/seen_samples.h"

#include <algorithm>
#include <bit>

#include "renderer/frame/geometry_buffer.h"

namespace penumbra::shadow_maps {

float float_at_place(std::uint32_t place) {
  return std::bit_cast<float>((place & 0x80000000u) != 0 ? place & 0x7fffffffu : ~place);
}

namespace {

constexpr VkFormat sample_depth_format = VK_FORMAT_D32_SFLOAT;

/// Numbers that are found for a view: least and greatest of three coordinates.
constexpr std::size_t bounds_of_view = 6;

glm::uvec2 grid_of(const TechniqueInput& input) {
  return {std::min(input.width, SeenSamples::most_side),
          std::min(input.height, SeenSamples::most_side)};
}

vulkan::Image make_grid(PrepareContext& context, const char* name, VkFormat format,
                        VkImageUsageFlags usage) {
  vulkan::ImageDescription description;
  description.format = format;
  description.width = grid_of(context.input).x;
  description.height = grid_of(context.input).y;
  description.usage = usage;
  return {context.device, context.memory, name, description};
}

}  // namespace

void SeenSamples::require(const TechniqueInput& input, Requirements& needs) {
  const glm::uvec2 grid = grid_of(input);
  const std::uint64_t samples = std::uint64_t{grid.x} * grid.y;
  const std::uint32_t side = std::max(grid.x, grid.y);
  needs.memory.push_back(
      {"seen samples", samples * vulkan::texel_bytes(GeometryBuffer::position_format), side});
  needs.memory.push_back(
      {"depth of seen samples", samples * vulkan::texel_bytes(sample_depth_format), side});
}

void SeenSamples::draw(PrepareContext& context) {
  if (!positions_) {
    positions_ = make_grid(context, "seen samples", GeometryBuffer::position_format,
                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    depth_ = make_grid(context, "depth of seen samples", sample_depth_format,
                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  }
  CasterProgram program;
  program.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shadow_maps/views/seen_samples.vert"},
                    {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shadow_maps/views/seen_samples.frag"}};
  program.all_surfaces = true;
  program.cull = VK_CULL_MODE_BACK_BIT;
  program.state.color_formats = {GeometryBuffer::position_format};
  program.state.depth_format = sample_depth_format;
  program.state.depth_test = program.state.depth_write = true;
  program.state.depth_compare = VK_COMPARE_OP_GREATER;
  const glm::mat4 clip_from_world(context.picture_camera.clip_from_world);
  vulkan::RenderTargets targets;
  targets.width = positions_.description().width;
  targets.height = positions_.description().height;
  targets.colors = {{positions_.slice(0), true, {}}};
  targets.depth = depth_.slice(0);
  targets.depth_format = sample_depth_format;
  targets.clear_depth = true;
  context.pass("seen samples", [&](vulkan::Commands& commands) {
    vulkan::Bindings bindings;
    bindings.buffer("SeenBlock", context.constants.push(clip_from_world));
    commands.begin_rendering(targets);
    context.draw_casters(commands, program, bindings, clip_from_world);
    commands.end_rendering();
  });
  drawn_ = true;
}

const vulkan::Image& SeenSamples::positions(PrepareContext& context) {
  if (!drawn_) draw(context);
  return positions_;
}

std::vector<Bounds> SeenSamples::bounds(PrepareContext& context,
                                        const std::vector<shader::MapView>& views, bool by_depth) {
  if (!drawn_) draw(context);
  if (!found_)
    found_ = {context.device,
              context.memory,
              "bounds of seen samples",
              shader::max_map_views * bounds_of_view * sizeof(std::uint32_t),
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
              vulkan::MemoryKind::readback};
  auto* places = static_cast<std::uint32_t*>(found_.mapped());
  for (std::size_t i = 0; i < shader::max_map_views * bounds_of_view; ++i)
    places[i] = i % bounds_of_view < 3 ? ~0u : 0u;

  shader::MapData data{};
  std::copy(views.begin(), views.end(), data.views);
  data.texel.z = static_cast<float>(views.size());
  vulkan::Bindings bindings = context.frame_bindings;
  bindings.buffer("MapBlock", context.constants.push(data));
  bindings.buffer("SeenBoundsBlock", found_.whole());
  bindings.texture("seen_positions", positions_, vulkan::Sampling::nearest);
  const vulkan::Pipeline& pipeline =
      context.pipelines.compute("renderer/shadow_maps/views/seen_bounds.comp");
  const vulkan::ImageDescription& grid = positions_.description();
  context.pass("bounds of seen samples", [&](vulkan::Commands& commands) {
    commands.bind(pipeline, bindings);
    commands.constants(by_depth ? 1u : 0u);
    // Groups of 8 x 8 invocations, each of which goes through a block of 8 x 8 samples.
    commands.dispatch((grid.width + 63) / 64, (grid.height + 63) / 64,
                      static_cast<std::uint32_t>(views.size()));
  });
  context.recorder.flush();

  std::vector<Bounds> list(views.size());
  for (std::size_t view = 0; view < views.size(); ++view) {
    const std::uint32_t* own = places + view * bounds_of_view;
    if (own[0] > own[3]) continue;
    list[view].add({float_at_place(own[0]), float_at_place(own[1]), float_at_place(own[2])});
    list[view].add({float_at_place(own[3]), float_at_place(own[4]), float_at_place(own[5])});
  }
  return list;
}

}  // namespace penumbra::shadow_maps
