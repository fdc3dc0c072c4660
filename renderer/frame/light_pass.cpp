#include "renderer/frame/light_pass.h"

#include <algorithm>
#include <stdexcept>

#include "renderer/frame/lit_part.h"
#include "renderer/frame/sample_list.h"

namespace penumbra {
namespace {

constexpr auto batch_size = static_cast<std::uint32_t>(shader::points_per_batch);

/// Points for samples that nothing hides the light from: over them light varies smoothly, and a
/// low-discrepancy mean of so many errs far below what a picture of 8 bits shows.
constexpr std::uint32_t few_per_pixel = 256;
constexpr std::uint32_t few_per_sample = 32;

std::uint32_t batch_count(std::size_t points) {
  return (static_cast<std::uint32_t>(points) + batch_size - 1) / batch_size;
}

}  // namespace

LightPass::LightPass(const FrameSetup& setup, const Bounds& scene_box, const Light& light,
                     const LightFit& fit)
    : setup_(setup),
      light_(world_light(light, setup.scene.origin())),
      input_(technique_input(setup.request, scene_box, light, setup.camera, setup.parameters)),
      technique_(setup.request.technique->create()),
      fit_(fit) {
  technique_->require(input_, needs_);
  declarations_ = setup_.declarations + needs_.definitions;
  sets_ = setup_.side * setup_.side;
  const std::uint32_t in_set = std::max(1u, needs_.light_points / sets_);
  has_scrambles_ =
      needs_.light_points > 1 && needs_.scrambles && in_set % Uncertainty::scrambles == 0;
}

void LightPass::choose_points(PointRange round) {
  if (needs_.light_points != setup_.request.light_samples) round = {0, needs_.light_points};
  if (round == round_) return;
  round_ = round;
  if (needs_.light_points <= 1) {
    points_.assign(sets_, glm::vec4(glm::dvec3(light_.center), 0.0));
    return;
  }
  const auto make = [&](std::uint32_t all, PointRange part) {
    return light_points(
        light_, all, sets_, setup_.request.seed, needs_.random_points,
        needs_.scrambles && all % Uncertainty::scrambles == 0 ? Uncertainty::scrambles : 1, part);
  };
  const std::uint32_t all = std::max(1u, needs_.light_points / sets_);
  const PointRange part{round.first / sets_, std::max(1u, round.count / sets_)};
  points_ = make(all, part);
  const std::uint32_t few = std::max(few_per_sample, few_per_pixel / sets_);
  few_points_ = few >= part.count || needs_.random_points ? points_ : make(few, {0, few});
}

/// A batch of each set's points. Places without a point repeat one.
LightPass::Batch LightPass::make_batch(const std::vector<glm::vec4>& points,
                                       std::uint32_t index) const {
  const auto per_set = static_cast<std::uint32_t>(points.size()) / sets_;
  const std::uint32_t first = index * batch_size;
  Batch batch;
  batch.count = std::min(batch_size, per_set - first);
  batch.weight = 1.0f / static_cast<float>(per_set);
  batch.points.assign(std::size_t{batch_size} * sets_, points.front());
  for (std::uint32_t set = 0; set < sets_; ++set)
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(set * per_set + first), batch.count,
                batch.points.begin() + static_cast<std::ptrdiff_t>(set * batch_size));
  return batch;
}

void LightPass::draw(const Frame& frame, const std::function<void(double)>& after_batch) {
  const std::uint32_t batches = batch_count(points_.size() / sets_);
  const bool many = needs_.light_points > 1;
  if (many) clear_sum(frame);
  const bool uncertain = has_scrambles_ && frame.uncertainty != nullptr;
  if (frame.uncertainty != nullptr)
    frame.recorder.pass("uncertainty", [&](vulkan::Commands& commands) {
      frame.uncertainty->clear_sums(commands);
    });
  const VkDeviceSize constants_mark = frame.constants.mark();
  for (std::uint32_t index = 0; index < batches; ++index) {
    // A light with many points is cut into submissions, so that it can report and be cancelled;
    // what a finished batch pushed is free again.
    if (index > 0) frame.constants.rewind(constants_mark);
    const Batch batch = make_batch(points_, index);
    const std::span<const glm::vec4> points(batch.points);
    vulkan::Bindings bindings = frame.frame_bindings;
    bindings.buffer("LightBlock", frame.constants.push(light_data(
                                      light_, static_cast<float>(batch.count), batch.weight)));
    bindings.buffer("LightPointBlock", frame.constants.push_array(points.first(batch_size)));
    PrepareContext context{
        input_,          setup_.scene,
        light_,          fit_,
        setup_.matrices, setup_.picture_matrices,
        frame.geometry,  frame.device,
        frame.pipelines, ledger_,
        frame.constants, frame.recorder,
        bindings,        declarations_,
        points,          points_,
        batch.count,     index,
        batches,         frame.frame_index,
        frame.notes,     needs_.adjacency ? &setup_.scene.adjacency(frame.device) : nullptr};
    technique_->prepare(context);
    if (many) {
      shade_points(frame, bindings, batch, false);
      if (index < batch_count(few_points_.size() / sets_))
        shade_points(frame, bindings, make_batch(few_points_, index), true);
    } else {
      shade(frame, bindings);
    }
    last_bindings_ = bindings;
    if (many) frame.recorder.flush();
    after_batch(static_cast<double>(index + 1) / batches);
  }
  if (many) add_sum(frame, last_bindings_);
  if (uncertain) {
    frame.recorder.flush();
    frame.uncertainty->add_light(frame.device, *frame.light_sum);
  }
}

std::string LightPass::program_path(vulkan::ShaderLibrary& shaders, const std::string& head) const {
  const std::string& technique = setup_.request.technique->shader;
  const std::string path = head + " with " + technique;
  if (!shaders.contains(path))
    shaders.add(path, "#include \"" + head + "\"\n#include \"" + technique + "\"\n");
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

void LightPass::shade(const Frame& frame, const vulkan::Bindings& bindings) {
  vulkan::Bindings named;
  technique_->bind(named);
  std::string passed = "#define PASSES_LIGHT\n";
  if (named.entries().contains("MapBlock")) passed += "#define PASSES_MAP\n";
  draw_light(frame, program_path(frame.shaders, "renderer/shaders/shade.glsl"), passed,
             [&](const vulkan::Pipeline& pipeline) {
               return shading_bindings(frame, bindings, pipeline);
             });
}

void LightPass::add_sum(const Frame& frame, const vulkan::Bindings& bindings) {
  draw_light(frame, "renderer/shaders/add_light.frag", "", [&](const vulkan::Pipeline&) {
    vulkan::Bindings all = bindings;
    all.texture("geometry_position", frame.geometry.position, vulkan::Sampling::nearest);
    all.texture("geometry_words", frame.geometry.words, vulkan::Sampling::nearest);
    all.texture("light_sum", *frame.light_sum, vulkan::Sampling::nearest);
    return all;
  });
}

/// Draws a program over the surfaces that this light may reach.
void LightPass::draw_light(
    const Frame& frame, const std::string& fragment_stage, const std::string& definitions,
    const std::function<vulkan::Bindings(const vulkan::Pipeline&)>& bindings_of) {
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, fragment_stage}};
  source.preamble = declarations_ + frame.output.definitions + definitions;
  source.constants_from_vertex = frame.device.reads_blocks_by_lane();
  if (needs_.shade_each_point) source.preamble += "#define SHADE_EACH_POINT\n";
  vulkan::GraphicsState state;
  state.color_formats = frame.output.formats;
  state.blend = frame.output.blend;
  vulkan::RenderTargets targets;
  targets.width = frame.geometry.width;
  targets.height = frame.geometry.height;
  targets.colors = frame.output.colors;
  // The triangle lies at infinity: only what is nearer, a surface, is shaded.
  state.depth_format = targets.depth_format = frame.geometry.depth.description().format;
  state.depth_test = true;
  state.depth_compare = VK_COMPARE_OP_LESS;
  targets.depth = frame.geometry.depth.slice(0);
  targets.depth_read_only = true;
  const vulkan::Pipeline& pipeline = frame.pipelines.graphics(source, state);
  const vulkan::Bindings all = bindings_of(pipeline);
  const VkRect2D reached = lit_part();
  frame.recorder.pass("shade", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    vkCmdSetScissor(commands.handle(), 0, 1, &reached);
    commands.bind(pipeline, all);
    commands.full_screen_triangle();
    commands.end_rendering();
  });
}

VkRect2D LightPass::lit_part() const {
  return seen_part(fit_.receivers, setup_.scene.origin(), setup_.matrices.clip_from_world,
                   setup_.width(), setup_.height());
}

void LightPass::clear_sum(const Frame& frame) {
  frame.recorder.pass("shade", [&](vulkan::Commands& commands) {
    vulkan::RenderTargets targets;
    targets.width = frame.geometry.width;
    targets.height = frame.geometry.height;
    targets.colors = {{frame.light_sum->slice(0), true, {}}};
    commands.begin_rendering(targets);
    commands.end_rendering();
  });
}

/// Adds a batch of points to the light's sums: at the samples of the technique's list that nothing
/// hides the light from, or at the others; at all that are not fully lit where it has no list.
void LightPass::shade_points(const Frame& frame, const vulkan::Bindings& bindings,
                             const Batch& batch, bool at_fully_lit) {
  const SampleList* list = technique_->lit_samples();
  if (list == nullptr && at_fully_lit) return;
  std::string preamble = declarations_;
  if (needs_.shade_each_point) preamble += "#define SHADE_EACH_POINT\n";
  if (list != nullptr) preamble += "#define WITH_SAMPLE_LIST\n";
  const bool uncertain = has_scrambles_ && frame.uncertainty != nullptr;
  if (uncertain) preamble += "#define WITH_UNCERTAINTY\n";
  const vulkan::Pipeline& pipeline = frame.pipelines.compute(
      program_path(frame.shaders, "renderer/shaders/shade_points.glsl"), preamble);
  vulkan::Bindings all = shading_bindings(frame, bindings, pipeline);
  all.storage_image("light_sum", *frame.light_sum);
  if (uncertain) all.storage_image("scramble_sums", frame.uncertainty->sums());
  all.buffer("LightBlock", frame.constants.push(
                               light_data(light_, static_cast<float>(batch.count), batch.weight)));
  if (list != nullptr) all.texel_buffer("listed_samples", list->texels.view);
  const std::span<const glm::vec4> points(batch.points);
  frame.recorder.pass("shade", [&](vulkan::Commands& commands) {
    for (std::uint32_t set = 0; set < sets_; ++set) {
      all.buffer("LightPointBlock",
                 frame.constants.push_array(points.subspan(set * batch_size, batch_size)));
      // Samples of a pixel add to the same sums.
      if (uncertain && set > 0) commands.barrier();
      commands.bind(pipeline, all);
      SampleWork work;
      work.set = set;
      if (list == nullptr) {
        dispatch_all(commands, setup_.width(), setup_.height(), setup_.side, work);
        continue;
      }
      for (const SampleList::Range& range : list->ranges)
        if (range.set == set && range.fully_lit == at_fully_lit)
          dispatch_range(commands, range, work);
    }
  });
}

void LightPass::draw_diagnostic(const Frame& frame, const std::string& name,
                                const vulkan::Image& target) {
  std::string function = "draw_diagnostic_" + name;
  std::replace(function.begin(), function.end(), '-', '_');
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT,
                    program_path(frame.shaders, "renderer/shaders/diagnostic.glsl")}};
  source.preamble = declarations_ + "#define DRAW_DIAGNOSTIC " + function + "\n";
  vulkan::GraphicsState state;
  state.color_formats = {target.description().format};
  const vulkan::Pipeline& pipeline = frame.pipelines.graphics(source, state);
  vulkan::Bindings all = shading_bindings(frame, last_bindings_, pipeline);
  if (frame.uncertainty != nullptr)
    all.texture("scramble_sums", frame.uncertainty->sums(), vulkan::Sampling::nearest);
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
