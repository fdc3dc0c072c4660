#include "renderer/shadow_volumes/deep_counts.h"

#include <stdexcept>

#include "renderer/shadow_volumes/stencil_volumes.h"

namespace penumbra::shadow_volumes {
namespace {

constexpr VkFormat format = VK_FORMAT_R32_SFLOAT;

/// DeepBitBlock of deep_bit.frag.
struct DeepBit {
  std::uint32_t bit;
  std::uint32_t most;
};

const char* step_of(VkStencilOp operation) {
  switch (operation) {
    case VK_STENCIL_OP_INCREMENT_AND_WRAP:
      return "1.0";
    case VK_STENCIL_OP_DECREMENT_AND_WRAP:
      return "-1.0";
    default:
      throw std::logic_error("a face of volumes neither adds nor takes away");
  }
}

}  // namespace

void DeepCounts::redirect(vulkan::ProgramSource& source, vulkan::GraphicsState& state) {
  const bool behind = state.depth_test && state.stencil_front.depth_fail != VK_STENCIL_OP_KEEP;
  const auto step = [&](const vulkan::StencilFace& face) {
    return step_of(behind ? face.depth_fail : face.pass);
  };
  source.preamble += std::string("#define DEEP_COUNT\n#define FRONT_STEP ") +
                     step(state.stencil_front) + "\n#define BACK_STEP " + step(state.stencil_back) +
                     "\n";
  source.stages.try_emplace(VK_SHADER_STAGE_FRAGMENT_BIT,
                            "renderer/shadow_volumes/deep_count.frag");
  // What fails the stencil's depth test is what is drawn now.
  if (behind) state.depth_compare = VK_COMPARE_OP_LESS_OR_EQUAL;
  for (vulkan::StencilFace* face : {&state.stencil_front, &state.stencil_back})
    face->pass = face->depth_fail = VK_STENCIL_OP_KEEP;
  state.color_formats = {format};
  state.blend = vulkan::Blend::add;
}

vulkan::ColorTarget DeepCounts::target(PrepareContext& context) {
  if (!counts_) {
    vulkan::ImageDescription description;
    description.format = format;
    description.width = context.geometry.width;
    description.height = context.geometry.height;
    description.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    counts_ = vulkan::Image(context.device, context.memory, "deep counts", description);
  }
  return {counts_.slice(0), true, {}};
}

void DeepCounts::store(PrepareContext& context, bool masked) const {
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shadow_volumes/deep_bit.frag"}};
  vulkan::RenderTargets targets;
  targets.width = context.geometry.width;
  targets.height = context.geometry.height;
  targets.depth = context.geometry.depth.slice(0);
  targets.depth_format = context.geometry.depth.description().format;
  vulkan::Bindings bindings = context.frame_bindings;
  bindings.texture("deep_counts", counts_, vulkan::Sampling::nearest);
  vulkan::GraphicsState state;
  state.depth_format = targets.depth_format;
  state.stencil_test = true;
  vulkan::StencilFace face;
  face.pass = VK_STENCIL_OP_REPLACE;
  face.reference = 0xff;
  if (masked) {
    face.compare = VK_COMPARE_OP_EQUAL;
    face.compare_mask = mask_bit;
  }
  const std::uint32_t most = most_counted(masked);
  context.pass("volumes", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    for (std::uint32_t bit = 1; bit <= most; bit <<= 1) {
      face.write_mask = bit;
      state.stencil_front = state.stencil_back = face;
      commands.bind(context.pipelines.graphics(source, state), bindings);
      commands.constants(DeepBit{bit, most});
      commands.full_screen_triangle();
    }
    commands.end_rendering();
  });
}

}  // namespace penumbra::shadow_volumes
