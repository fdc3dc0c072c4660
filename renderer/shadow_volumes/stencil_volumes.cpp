#include "renderer/shadow_volumes/stencil_volumes.h"

#include "renderer/shadow_volumes/volume_draws.h"

namespace penumbra::shadow_volumes {
namespace {

vulkan::GraphicsState stencil_state(const PrepareContext& context, const VolumeOptions& options) {
  vulkan::GraphicsState state;
  state.depth_format = context.geometry.depth.description().format;
  state.vertex_input = vulkan::VertexInput::position;
  state.topology = volume_topology(options.every_edge);
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
  vulkan::ProgramSource source =
      volume_program("renderer/shadow_volumes/volume.geom", options.every_edge);
  vulkan::GraphicsState state = stencil_state(context, options);
  std::vector<const vulkan::Pipeline*> pipelines;
  if (options.counting == Counting::behind) source.preamble += "#define WITH_CAPS\n";
  if (options.exact_sides) {
    vulkan::ProgramSource sides =
        volume_program("renderer/shadow_volumes/volume.geom", options.every_edge);
    sides.preamble += "#define EDGES_ALONG\n";
    sides.stages[VK_SHADER_STAGE_FRAGMENT_BIT] = "renderer/shadow_volumes/exact_side.frag";
    vulkan::GraphicsState every_depth = state;
    every_depth.depth_test = false;
    every_depth.stencil_front.pass = state.stencil_front.depth_fail;
    every_depth.stencil_back.pass = state.stencil_back.depth_fail;
    pipelines.push_back(&context.pipelines.graphics(sides, every_depth));
    source.preamble += "#define CAPS_ONLY\n";
  }
  pipelines.push_back(&context.pipelines.graphics(source, state));

  vulkan::RenderTargets targets;
  targets.width = context.geometry.width;
  targets.height = context.geometry.height;
  targets.depth = context.geometry.depth.slice(0);
  targets.depth_format = context.geometry.depth.description().format;
  targets.clear_stencil = true;
  const VolumeDraws draws =
      list_volume_draws(context, options.every_edge, options.clamp, options.light_radius);
  context.pass("volumes", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    for (const vulkan::Pipeline* pipeline : pipelines) {
      commands.bind(*pipeline, context.frame_bindings);
      draws.record(commands, context.scene);
    }
    commands.end_rendering();
  });
}

void StencilVolumes::bind(vulkan::Bindings& bindings) const {
  bindings.stencil("volume_count", *stencil_);
}

}  // namespace penumbra::shadow_volumes
