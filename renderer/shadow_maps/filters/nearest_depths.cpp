#include "renderer/shadow_maps/filters/nearest_depths.h"

#include <algorithm>
#include <bit>

namespace penumbra::shadow_maps {

namespace {

/// Texels along a side of the first level; the others stand beside it.
std::uint32_t base_of(std::uint32_t map_size) {
  return std::bit_ceil((map_size + 1) / 2);
}

}  // namespace

void NearestDepths::require(const TechniqueInput& input, Requirements& needs) {
  if (!keeps_image(input.parameters)) return;
  const std::uint32_t base =
      base_of(static_cast<std::uint32_t>(integer_of(input.parameters, "map_size")));
  needs.memory.push_back({"nearest depths",
                          std::uint64_t{2} * base * base * view_count(input) *
                              vulkan::texel_bytes(VK_FORMAT_R32_SFLOAT),
                          2 * base, "map_size"});
}

void NearestDepths::draw(PrepareContext& context, const DepthMap& depth) {
  if (!depth.image()) return;
  const vulkan::ImageDescription& map = depth.image().description();
  const std::uint32_t base = base_of(map.width);
  if (!image_) {
    vulkan::ImageDescription description = map;
    description.format = VK_FORMAT_R32_SFLOAT;
    description.width = 2 * base;
    description.height = base;
    description.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    image_ = vulkan::Image(context.device, context.memory, "nearest depths", description);
  }
  const char* path = "renderer/shadow_maps/filters/nearest_depths.comp";
  const vulkan::Pipeline& from_map = context.pipelines.compute(path, "#define FROM_MAP\n");
  const vulkan::Pipeline& from_level = context.pipelines.compute(path);
  vulkan::Bindings bindings;
  bindings.texture("shadow_map", depth.image(), vulkan::Sampling::nearest);
  bindings.storage_image("chain", image_);
  context.pass("nearest depths", [&](vulkan::Commands& commands) {
    for (std::uint32_t level = 0; base >> level > 0; ++level) {
      struct {
        std::int32_t level, base;
      } const step{static_cast<std::int32_t>(level), static_cast<std::int32_t>(base)};
      const std::uint32_t groups = ((base >> level) + 7) / 8;
      commands.bind(level == 0 ? from_map : from_level, bindings);
      commands.constants(step);
      commands.dispatch(groups, groups, map.layers);
      commands.barrier();
    }
  });
}

void NearestDepths::bind(vulkan::Bindings& bindings) const {
  if (image_) bindings.texture("nearest_depths", image_, vulkan::Sampling::nearest);
}

}  // namespace penumbra::shadow_maps
