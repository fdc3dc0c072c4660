#include "renderer/frame/light_pass.h"

#include <algorithm>
#include <stdexcept>

namespace penumbra {

LightPass::LightPass(const FrameSetup& setup, const Light& light)
    : setup_(setup),
      light_(world_light(light, setup.scene.origin())),
      input_{setup.scene.scene(),
             light,
             setup.camera,
             setup.parameters,
             setup.width,
             setup.height,
             setup.request.light_samples,
             setup.request.seed},
      technique_(setup.request.technique->create()) {
  technique_->require(input_, needs_);
  const std::uint32_t sets = setup.side * setup.side;
  if (needs_.light_points > 1) {
    points_per_set_ = std::max(1u, needs_.light_points / sets);
    points_ = light_points(light_, points_per_set_, sets, setup.request.seed, needs_.random_points);
  } else {
    const glm::dvec3 center =
        light.kind == LightKind::directional ? -light_.direction : light_.position;
    points_.assign(sets, glm::vec4(center, 0.0));
  }
}

void LightPass::draw(const Frame& frame, const std::function<void(double)>& after_batch) {
  constexpr auto batch_size = static_cast<std::uint32_t>(shader::points_per_batch);
  const std::uint32_t sets = setup_.side * setup_.side;
  const std::uint32_t batches = (points_per_set_ + batch_size - 1) / batch_size;
  const VkDeviceSize constants_mark = frame.constants.mark();
  for (std::uint32_t batch = 0; batch < batches; ++batch) {
    // A light with many points is cut into submissions, so that it can report and be cancelled; what
    // a finished batch pushed is free again.
    if (batch > 0) frame.constants.rewind(constants_mark);
    const std::uint32_t first = batch * batch_size;
    const std::uint32_t count = std::min(batch_size, points_per_set_ - first);
    std::vector<glm::vec4> points(std::size_t{batch_size} * shader::max_supersampling,
                                  points_.front());
    for (std::uint32_t set = 0; set < sets; ++set)
      std::copy_n(points_.begin() + static_cast<std::ptrdiff_t>(set * points_per_set_ + first),
                  count, points.begin() + static_cast<std::ptrdiff_t>(set * batch_size));
    const float weight = static_cast<float>(count) / static_cast<float>(points_per_set_);
    vulkan::Bindings bindings = frame.frame_bindings;
    bindings.buffer("LightBlock",
                    frame.constants.push(light_data(light_, static_cast<float>(count), weight)));
    bindings.buffer("LightPointBlock",
                    frame.constants.push_array(std::span<const glm::vec4>(points)));
    const auto own_points = std::span<const glm::vec4>(points).first(sets * batch_size);
    PrepareContext context{input_,          setup_.scene,   light_,          setup_.matrices,
                           frame.geometry,  frame.device,   frame.pipelines, ledger_,
                           frame.constants, frame.recorder, bindings,        setup_.declarations,
                           own_points,      count,          batch,           batches,         frame.frame_index,
                           frame.notes,
                           needs_.adjacency ? &setup_.scene.adjacency(frame.device) : nullptr};
    technique_->prepare(context);
    shade(frame, bindings, batch == 0);
    last_bindings_ = bindings;
    if (needs_.light_points > 1) frame.recorder.flush();
    after_batch(static_cast<double>(batch + 1) / batches);
  }
}

std::string LightPass::program_path(vulkan::ShaderLibrary& library, const std::string& head) const {
  const std::string& technique = setup_.request.technique->shader;
  const std::string path = head + " with " + technique;
  if (!library.contains(path))
    library.add(path, "#include \"" + head + "\"\n#include \"" + technique + "\"\n");
  return path;
}

vulkan::Bindings LightPass::shading_bindings(const Frame& frame,
                                             const vulkan::Bindings& light_bindings,
                                             const vulkan::Pipeline& pipeline) const {
  vulkan::Bindings named;
  technique_->bind(named);
  const auto& declared = pipeline.program.declared;
  for (const auto& [name, entry] : named.entries())
    if (std::find(declared.begin(), declared.end(), name) == declared.end())
      throw std::logic_error("technique " + setup_.request.technique->id + " binds " + name +
                             ", which its shader does not declare");
  vulkan::Bindings all = light_bindings;
  all.add(named);
  all.texture("geometry_position", frame.geometry.position, vulkan::Sampling::nearest);
  all.texture("geometry_words", frame.geometry.words, vulkan::Sampling::nearest);
  return all;
}

void LightPass::shade(const Frame& frame, const vulkan::Bindings& bindings, bool first_batch) {
  vulkan::ProgramSource source;
  source.stages = {
      {VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
      {VK_SHADER_STAGE_FRAGMENT_BIT, program_path(frame.library, "renderer/shaders/shade.glsl")}};
  source.preamble = setup_.declarations;
  if (needs_.light_points > 1) source.preamble += "#define MANY_POINTS\n";
  if (needs_.shade_each_point) source.preamble += "#define SHADE_EACH_POINT\n";
  if (frame.visibility != nullptr) source.preamble += "#define WITH_VISIBILITY\n";
  vulkan::GraphicsState state;
  state.color_formats = {GeometryBuffer::radiance_format};
  state.blend = vulkan::Blend::add;
  vulkan::RenderTargets targets;
  targets.width = frame.geometry.width;
  targets.height = frame.geometry.height;
  targets.colors = {{frame.geometry.radiance.slice(0), false, {}}};
  if (frame.visibility != nullptr) {
    state.color_formats.push_back(frame.visibility->description().format);
    targets.colors.push_back({frame.visibility->slice(0), first_batch, {}});
  }
  const vulkan::Pipeline& pipeline = frame.pipelines.graphics(source, state);
  const vulkan::Bindings all = shading_bindings(frame, bindings, pipeline);
  frame.recorder.pass("shade", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    commands.bind(pipeline, all);
    commands.full_screen_triangle();
    commands.end_rendering();
  });
}

void LightPass::draw_diagnostic(const Frame& frame, const std::string& name,
                                const vulkan::Image& target) {
  std::string function = "draw_diagnostic_" + name;
  std::replace(function.begin(), function.end(), '-', '_');
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT,
                    program_path(frame.library, "renderer/shaders/diagnostic.glsl")}};
  source.preamble = setup_.declarations + "#define DRAW_DIAGNOSTIC " + function + "\n";
  vulkan::GraphicsState state;
  state.color_formats = {target.description().format};
  const vulkan::Pipeline& pipeline = frame.pipelines.graphics(source, state);
  const vulkan::Bindings all = shading_bindings(frame, last_bindings_, pipeline);
  frame.recorder.pass("diagnostic", [&](vulkan::Commands& commands) {
    vulkan::RenderTargets targets;
    targets.width = frame.geometry.width;
    targets.height = frame.geometry.height;
    targets.colors = {{target.slice(0), false, {}}};
    commands.begin_rendering(targets);
    commands.bind(pipeline, all);
    commands.full_screen_triangle();
    commands.end_rendering();
  });
}

}  // namespace penumbra
