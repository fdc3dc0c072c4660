// What a frame becomes: outputs of its lights, and the passes that finish pictures.
#include <algorithm>
#include <cstring>
#include <glm/gtc/color_space.hpp>

#include "renderer/frame/common_parameters.h"
#include "renderer/frame/frame_run.h"
#include "renderer/frame/host_copy.h"
#include "renderer/frame/lit_part.h"

namespace penumbra {
namespace {

vulkan::ProgramSource resolve_program(const std::string& definition) {
  return {{{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
           {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shaders/resolve.frag"}},
          definition};
}

}  // namespace

bool FrameRun::light_finishes() const {
  return setup_.side == 1 && std::count(plan_.lights.begin(), plan_.lights.end(), true) <= 1;
}

LightPass::Output FrameRun::light_output(bool first) const {
  LightPass::Output output;
  if (light_finishes()) {
    output = begun_picture();
    output.definitions += "#define FINISHES\n";
  } else {
    output.formats = {FrameTargets::radiance_format};
    output.colors = {{targets_.radiance.slice(0), first, {}}};
    output.blend = vulkan::Blend::add;
  }
  if (request_.visibility) {
    output.definitions += "#define WITH_VISIBILITY\n#define VISIBILITY_LOCATION " +
                          std::to_string(output.formats.size()) + "\n";
    output.formats.push_back(FrameTargets::visibility_format);
    output.colors.push_back({targets_.visibility_samples.slice(0), true, {}});
  }
  return output;
}

LightPass::Output FrameRun::picture_output() const {
  LightPass::Output output;
  output.formats = {FrameTargets::picture_format};
  output.colors = {{targets_.picture.slice(0), false, {}}};
  if (targets_.geometry.emitted) output.definitions = "#define EMISSIVE\n";
  if (targets_.linear) {
    output.definitions += "#define WITH_LINEAR\n";
    output.formats.push_back(FrameTargets::linear_format);
    output.colors.push_back({targets_.linear.slice(0), false, {}});
  }
  return output;
}

/// One that is the same everywhere is there before anything is drawn.
LightPass::Output FrameRun::begun_picture() const {
  LightPass::Output output = picture_output();
  const Scene& scene = *request_.scene;
  if (scene.background_low != scene.background_high) return output;
  const glm::vec3 linear = exposure_factor(request_) * scene.background_low;
  const glm::vec3 shown = glm::clamp(linear, 0.0f, 1.0f);
  const bool encodes = gamma_treatment(setup_.parameters).encodes;
  const glm::vec3 encoded = encodes ? glm::convertLinearToSRGB(shown) : shown;
  output.colors[0] = {output.colors[0].view, true, {{encoded.r, encoded.g, encoded.b, 1.0f}}};
  if (targets_.linear)
    output.colors[1] = {output.colors[1].view, true, {{linear.r, linear.g, linear.b, 1.0f}}};
  return output;
}

std::vector<FrameRun::Resolve> FrameRun::unfinished_parts() const {
  const Scene& scene = *request_.scene;
  std::vector<Resolve> parts;
  if (scene.background_low != scene.background_high)
    parts.push_back({resolve_program("#define SKY\n"), whole(), VK_COMPARE_OP_EQUAL});
  const bool dark = scene.ambient == glm::vec3(0.0f) && !targets_.geometry.emitted;
  const std::size_t light = first_light();
  const VkRect2D lit = light < lights_.size() ? lights_[light]->lit_part() : VkRect2D{};
  for (const VkRect2D& rest : outside(lit, setup_.window.width, setup_.window.height))
    parts.push_back(
        {resolve_program(dark ? "#define BLACK\n" : "#define UNLIT\n"), rest, VK_COMPARE_OP_LESS});
  return parts;
}

void FrameRun::resolve(const vulkan::Bindings& bindings) {
  if (light_finishes()) {
    const bool begun = first_light() < lights_.size();
    draw_resolve(bindings, begun ? picture_output() : begun_picture(), unfinished_parts());
    return;
  }
  vulkan::Bindings all = bindings;
  all.texture("radiance", targets_.radiance, vulkan::Sampling::nearest);
  draw_resolve(all, picture_output(),
               {{resolve_program(setup_.side == 1 ? "#define ONE_SAMPLE\n" : ""), whole(),
                 VK_COMPARE_OP_ALWAYS}});
}

void FrameRun::draw_resolve(const vulkan::Bindings& bindings, const LightPass::Output& output,
                            std::vector<Resolve> parts) {
  if (parts.empty()) return;
  vulkan::RenderTargets targets;
  targets.width = setup_.window.width;
  targets.height = setup_.window.height;
  targets.colors = output.colors;
  vulkan::GraphicsState state;
  state.color_formats = output.formats;
  if (parts.front().depth != VK_COMPARE_OP_ALWAYS) {
    targets.depth = targets_.geometry.depth.slice(0);
    state.depth_format = targets.depth_format = targets_.geometry.depth.description().format;
    targets.depth_read_only = state.depth_test = true;
  }
  state_.recorder.pass("resolve", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    for (Resolve& part : parts) {
      part.program.preamble += output.definitions;
      part.program.constants_from_vertex = state_.device.reads_blocks_by_lane();
      state.depth_compare = part.depth;
      commands.bind(state_.pipelines.graphics(part.program, state), bindings);
      vkCmdSetScissor(commands.handle(), 0, 1, &part.area);
      commands.full_screen_triangle();
    }
    commands.end_rendering();
  });
}

void FrameRun::resolve_visibility(const vulkan::Bindings& bindings, std::uint32_t light) {
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shaders/resolve_visibility.frag"}};
  vulkan::GraphicsState state;
  state.color_formats = {FrameTargets::visibility_format};
  vulkan::Bindings all = bindings;
  all.texture("visibility_samples", targets_.visibility_samples, vulkan::Sampling::nearest);
  const vulkan::Pipeline& pipeline = state_.pipelines.graphics(source, state);
  state_.recorder.pass("resolve visibility", [&](vulkan::Commands& commands) {
    commands.begin_rendering({setup_.window.width,
                              setup_.window.height,
                              {{targets_.visibility.slice(light), false, {}}}});
    commands.bind(pipeline, all);
    commands.full_screen_triangle();
    commands.end_rendering();
  });
}

void FrameRun::encode(const ImageF& linear) {
  write_float(state_.device, targets_.linear, linear);
  state_.constants.reset();
  std::memset(state_.faults.mapped(), 0, state_.faults.size());
  vulkan::Bindings bindings = frame_bindings();
  state_.recorder.begin(false);
  LightPass::Output output;
  output.formats = {FrameTargets::picture_format};
  output.colors = {{targets_.picture.slice(0), false, {}}};
  bindings.texture("linear_picture", targets_.linear, vulkan::Sampling::nearest);
  draw_resolve(bindings, output,
               {{resolve_program("#define FROM_LINEAR\n"), whole(), VK_COMPARE_OP_ALWAYS}});
  state_.recorder.end();
}

}  // namespace penumbra
