#include "renderer/shadow_maps/nearest_depths.h"

#include <algorithm>
#include <bit>

namespace penumbra::shadow_maps {

void NearestDepths::draw(PrepareContext& context, const DepthMap& depth) {
  const vulkan::ImageDescription& map = depth.image().description();
  if (!image_) {
    vulkan::ImageDescription description = map;
    description.format = VK_FORMAT_R32_SFLOAT;
    description.width = description.height = std::max(map.width / 2, 1u);
    description.levels = static_cast<std::uint32_t>(std::bit_width(description.width));
    description.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    image_ = vulkan::Image(context.device, context.memory, "nearest depths", description);
  }
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shadow_maps/nearest_depths.frag"}};
  vulkan::GraphicsState state;
  state.color_formats = {image_.description().format};
  const vulkan::Pipeline& pipeline = context.pipelines.graphics(source, state);
  context.pass("nearest depths", [&](vulkan::Commands& commands) {
    for (std::uint32_t level = 0; level < image_.description().levels; ++level) {
      commands.barrier();
      vulkan::RenderTargets targets;
      targets.width = targets.height = std::max(image_.description().width >> level, 1u);
      for (std::uint32_t face = 0; face < map.layers; ++face) {
        vulkan::Bindings bindings;
        if (level == 0)
          bindings.texture_slice("finer_depths", depth.image(), face, 0, vulkan::Sampling::nearest);
        else
          bindings.texture_slice("finer_depths", image_, face, level - 1,
                                 vulkan::Sampling::nearest);
        targets.colors = {{image_.slice(face, level), false, {}}};
        commands.begin_rendering(targets);
        commands.bind(pipeline, bindings);
        commands.full_screen_triangle();
        commands.end_rendering();
      }
    }
  });
}

void NearestDepths::bind(vulkan::Bindings& bindings) const {
  bindings.texture("nearest_depths", image_, vulkan::Sampling::nearest);
}

}  // namespace penumbra::shadow_maps
