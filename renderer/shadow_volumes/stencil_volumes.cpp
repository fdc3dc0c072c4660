#include "renderer/shadow_volumes/stencil_volumes.h"

#include <algorithm>
#include <set>

#include "renderer/frame/caster_defects.h"
#include "renderer/shadow_volumes/hidden_casters.h"
#include "renderer/shadow_volumes/near_plane.h"
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
  // A view whose far plane is at infinity needs no clamp; without one, triangles are clipped just
  // as they were when the depth was drawn. Where depth ends, what is behind its end counts.
  state.depth_clamp = options.counting == Counting::behind && context.camera.ends;
  state.stencil_test = true;
  if (options.counting == Counting::behind) {
    state.stencil_front.depth_fail = VK_STENCIL_OP_DECREMENT_AND_WRAP;
    state.stencil_back.depth_fail = VK_STENCIL_OP_INCREMENT_AND_WRAP;
  } else {
    state.stencil_front.pass = VK_STENCIL_OP_INCREMENT_AND_WRAP;
    state.stencil_back.pass = VK_STENCIL_OP_DECREMENT_AND_WRAP;
  }
  if (options.masked)
    for (vulkan::StencilFace* face : {&state.stencil_front, &state.stencil_back}) {
      face->compare = VK_COMPARE_OP_EQUAL;
      face->reference = face->compare_mask = mask_bit;
      face->write_mask = most_counted(true);
    }
  return state;
}

vulkan::RenderTargets targets_of(const PrepareContext& context) {
  vulkan::RenderTargets targets;
  targets.width = context.geometry.width;
  targets.height = context.geometry.height;
  targets.depth = context.geometry.depth.slice(0);
  targets.depth_format = context.geometry.depth.description().format;
  return targets;
}

/// Casters that the camera looks through.
std::set<std::uint32_t> masked_instances(const PrepareContext& context) {
  std::set<std::uint32_t> instances;
  for (const DrawRange& range : context.scene.ranges())
    if (range.masked && range.casts_shadow) instances.insert(range.instance);
  return instances;
}

void note_ignored_masks(PrepareContext& context) {
  if (has_masked_casters(context.scene))
    context.notes.push_back(
        "shadow volumes ignore alpha masks: masked casters cast the shadows of whole triangles");
}

/// What is not the closed surface of a body, and what is done with it.
void note_defects(PrepareContext& context, const VolumeOptions& options) {
  if (options.every_edge) {
    if (const std::size_t open = open_casters(context.scene); open > 0)
      context.notes.push_back(
          "casters with open edges, of which only triangles that look at the light cast shadows, "
          "and "
          "whose shadows are wrong where the camera looks through them: " +
          std::to_string(open));
    return;
  }
  if (context.adjacency == nullptr) return;
  const Adjacency& adjacency = context.adjacency->host;
  std::set<std::uint32_t> open;
  for (const AdjacencyGroup& group : adjacency.groups)
    if (!group.closed && group.casts_shadow) open.insert(group.instance);
  if (!open.empty())
    context.notes.push_back("casters with open edges, which count as silhouettes: " +
                            std::to_string(open.size()));
  if (adjacency.non_manifold_edges > 0)
    context.notes.push_back("edges of more than two triangles, paired by the closest normals: " +
                            std::to_string(adjacency.non_manifold_edges));
}

}  // namespace

VolumeTriangles volume_triangles(const PrepareContext& context, bool every_edge) {
  VolumeTriangles triangles;
  triangles.lit = every_edge;
  if (every_edge) return triangles;
  triangles.sheets = masked_instances(context);
  for (const AdjacencyGroup& group : context.adjacency->host.groups)
    if (!group.closed) triangles.sheets.insert(group.instance);
  return triangles;
}

Parameter ablation_parameter() {
  return choice("ablation", "none",
                {"none", "far-clipped", "uncapped", "gaps-ignored", "first-corner"},
                "Leaves one precaution out, to show what it is for. far-clipped: volumes are cut "
                "off by a far plane behind the last visible surface. uncapped: volumes have sides "
                "only. gaps-ignored: meshes with gaps are taken for closed ones. first-corner: the "
                "side of a triangle that looks at the light is decided by the direction to its "
                "first corner.")
      .ablating();
}

Parameter clamp_parameter() {
  return boolean("clamp", false,
                 "Culls casters that cannot shadow anything visible and, where shadows are hard, "
                 "those that lie in the shadow of another, and ends volumes behind the last "
                 "visible surface instead of at infinity.");
}

std::vector<Parameter> volume_parameters() {
  const Parameter passes =
      integer("stencil_passes", 1, {1, 2},
              "1: front and back faces of volumes are counted in one pass by a two-sided stencil. "
              "2: in a pass each, as before there was one.");
  return {clamp_parameter(), passes};
}

VolumeOptions volume_options(const ParameterValues& parameters) {
  VolumeOptions options;
  options.clamp = boolean_of(parameters, "clamp");
  options.stencil_passes = static_cast<int>(integer_of(parameters, "stencil_passes"));
  if (parameters.contains("ablation")) {
    const std::vector<std::string> choices = ablation_parameter().choices;
    const auto chosen =
        std::find(choices.begin(), choices.end(), choice_of(parameters, "ablation"));
    options.ablation = static_cast<Ablation>(chosen - choices.begin());
  }
  return options;
}

Diagnostic count_diagnostic() {
  return {"count",
          "Volumes that each sample lies in: grey none, yellow to red one to 32 and more, blue a "
          "count that fell below zero."};
}

/// A draw of some casters with one state.
struct StencilVolumes::Step {
  const vulkan::Pipeline* pipeline;
  vulkan::Bindings bindings;
  const VolumeDraws* draws;
  VkCullModeFlags cull;
  bool open_caps;  ///< of open meshes only, at their own triangles

  void record(vulkan::Commands& commands, const GpuScene& scene) const {
    commands.bind(*pipeline, bindings);
    commands.cull(cull);
    if (open_caps)
      draws->record_open_caps(commands, pipeline->program.push_constants);
    else
      draws->record(commands, scene);
  }
};

/// Where to count fragments instead of volumes.
struct StencilVolumes::Counter {
  vulkan::BufferRange counts;
  std::uint32_t place;

  void apply(vulkan::ProgramSource& source, vulkan::GraphicsState& state,
             vulkan::Bindings& bindings) const {
    source.stages[VK_SHADER_STAGE_FRAGMENT_BIT] = "renderer/shadow_volumes/count_fragments.frag";
    source.preamble += "#define COUNTER " + std::to_string(place) + "\n";
    state.depth_test = false;
    for (vulkan::StencilFace* face : {&state.stencil_front, &state.stencil_back})
      face->pass = face->depth_fail = VK_STENCIL_OP_KEEP;
    bindings.buffer("FragmentCountBlock", counts);
  }
};

void StencilVolumes::add_steps(PrepareContext& context, const VolumeOptions& options,
                               const VolumeDraws& draws, std::vector<Step>& steps,
                               const Counter* counter) {
  const auto add = [&](vulkan::ProgramSource source, vulkan::GraphicsState state, bool open_caps) {
    if (options.ablation == Ablation::gaps_ignored) source.preamble += "#define GAPS_IGNORED\n";
    if (options.ablation == Ablation::first_corner) source.preamble += "#define FIRST_CORNER\n";
    if (options.ablation == Ablation::far_clipped)
      source.stages[VK_SHADER_STAGE_FRAGMENT_BIT] = "renderer/shadow_volumes/far_clip.frag";
    vulkan::Bindings bindings = context.frame_bindings;
    if (open_caps) bind_corners(bindings, context);
    if (counter != nullptr)
      counter->apply(source, state, bindings);
    else if (is_deep(context, options))
      DeepCounts::redirect(source, state);
    const vulkan::Pipeline& pipeline = context.pipelines.graphics(source, state);
    const bool two_sided = options.stencil_passes == 1;
    steps.push_back({&pipeline, bindings, &draws,
                     two_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT, open_caps});
    if (two_sided) return;
    steps.push_back(steps.back());
    steps.back().cull = VK_CULL_MODE_FRONT_BIT;
  };
  vulkan::ProgramSource source =
      volume_program("renderer/shadow_volumes/volume.geom", options.every_edge);
  vulkan::GraphicsState state = stencil_state(context, options);
  const bool capped =
      options.counting == Counting::behind && options.ablation != Ablation::uncapped;
  if (capped) source.preamble += "#define WITH_CAPS\n";
  if (options.exact_sides) {
    vulkan::ProgramSource sides =
        volume_program("renderer/shadow_volumes/volume.geom", options.every_edge);
    sides.preamble += "#define EDGES_ALONG\n";
    sides.stages[VK_SHADER_STAGE_FRAGMENT_BIT] = "renderer/shadow_volumes/exact_side.frag";
    vulkan::GraphicsState every_depth = state;
    every_depth.depth_test = false;
    every_depth.stencil_front.pass = state.stencil_front.depth_fail;
    every_depth.stencil_back.pass = state.stencil_back.depth_fail;
    add(sides, every_depth, false);
    source.preamble += "#define CAPS_ONLY\n";
  }
  add(source, state, false);
  // Counted before the surface, a cap counts where the camera looks through it: through holes of
  // masks and through sheets from behind.
  if (options.ablation == Ablation::uncapped || options.every_edge || !draws.any_open()) return;
  vulkan::ProgramSource caps;
  caps.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shadow_volumes/open_cap.vert"}};
  state.vertex_input = vulkan::VertexInput::none;
  state.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  // Clipped at the near plane as the geometry buffer was; the far plane is behind all casters.
  state.depth_clamp = false;
  add(caps, state, true);
}

void StencilVolumes::add_near_caps(PrepareContext& context, const VolumeOptions& options,
                                   const NearPlane& near_plane, const VolumeDraws& draws,
                                   std::vector<Step>& steps) {
  const auto near_from_caster = near_plane.near_from_caster();
  if (!near_from_caster) return;
  vulkan::GraphicsState state = stencil_state(context, options);
  state.depth_test = false;
  state.depth_clamp = false;
  state.stencil_front.pass = state.stencil_back.pass = VK_STENCIL_OP_INCREMENT_AND_WRAP;
  vulkan::Bindings bindings = context.frame_bindings;
  bindings.buffer("NearPlaneBlock", context.constants.push(*near_from_caster));
  auto source = volume_program("renderer/shadow_volumes/near_cap.geom", options.every_edge);
  if (is_deep(context, options)) DeepCounts::redirect(source, state);
  steps.push_back(
      {&context.pipelines.graphics(source, state), bindings, &draws, VK_CULL_MODE_NONE, false});
}

bool StencilVolumes::is_deep(const PrepareContext& context, const VolumeOptions& options) {
  if (!deep_)
    deep_ = may_crowd(context.scene, context.light, volume_triangles(context, options.every_edge),
                      most_counted(options.masked));
  return *deep_;
}

VolumeDrawOptions StencilVolumes::draws_wanted(const PrepareContext& context,
                                               const VolumeOptions& options) {
  VolumeDrawOptions wanted;
  wanted.every_edge = options.every_edge;
  wanted.clamp = options.clamp;
  wanted.gaps_ignored = options.ablation == Ablation::gaps_ignored;
  wanted.light_radius = options.light_radius;
  // Whole shadows only: of one point, of both sides of every sheet, with every silhouette.
  if (options.clamp && options.light_radius == 0.0 && !options.every_edge &&
      options.ablation == Ablation::none) {
    if (!hidden_) hidden_ = find_hidden_casters(context.scene, context.light);
    wanted.hidden = *hidden_;
  }
  return wanted;
}

void StencilVolumes::draw(PrepareContext& context, const VolumeOptions& options) {
  stencil_ = &context.geometry.depth;
  note_ignored_masks(context);
  note_defects(context, options);
  const NearPlane near_plane(context);
  const auto in_shadow = [&](const glm::vec3& low, const glm::vec3& high) {
    return near_plane.may_be_in_shadow_of(low, high);
  };
  VolumeDrawOptions wanted = draws_wanted(context, options);
  VolumeDraws draws, outside, shading_camera;
  std::vector<Step> steps;
  if (options.automatic) {
    VolumeOptions before = options;
    before.counting = Counting::before;
    wanted.accept = [&](const glm::vec3& low, const glm::vec3& high) {
      return !in_shadow(low, high);
    };
    wanted.as_sheets = masked_instances(context);
    outside = list_volume_draws(context, wanted);
    add_steps(context, before, outside, steps, nullptr);
    wanted.as_sheets.clear();
    wanted.accept = in_shadow;
  }
  if (options.counting == Counting::before) wanted.as_sheets = masked_instances(context);
  draws = list_volume_draws(context, wanted);
  add_steps(context, options, draws, steps, nullptr);
  if (options.counting == Counting::before && !options.near_caps) {
    wanted.accept = in_shadow;
    if (!list_volume_draws(context, wanted).draws.empty())
      context.notes.push_back(
          "the camera may stand in a shadow, or its near plane cut one: volumes counted before the "
          "surface are wrong then");
  }
  if (options.near_caps) {
    // What is culled has neither sides nor caps; besides, only what lies between light and near
    // plane has caps.
    wanted.accept = in_shadow;
    shading_camera = list_volume_draws(context, wanted);
    add_near_caps(context, options, near_plane, shading_camera, steps);
  }

  vulkan::RenderTargets targets = targets_of(context);
  targets.clear_stencil = !options.masked;
  if (is_deep(context, options)) targets.colors = {counts_.target(context)};
  context.pass("volumes", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    for (const Step& step : steps) step.record(commands, context.scene);
    commands.end_rendering();
  });
  if (is_deep(context, options)) counts_.store(context, options.masked);
}

void StencilVolumes::count_fragments(PrepareContext& context, const VolumeOptions& options,
                                     vulkan::BufferRange counts, std::uint32_t counter) {
  const VolumeDraws draws = list_volume_draws(context, draws_wanted(context, options));
  const Counter into{counts, counter};
  std::vector<Step> steps;
  add_steps(context, options, draws, steps, &into);
  const vulkan::RenderTargets targets = targets_of(context);
  context.pass("count fragments", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    for (const Step& step : steps) step.record(commands, context.scene);
    commands.end_rendering();
  });
}

void StencilVolumes::bind(vulkan::Bindings& bindings) const {
  bindings.stencil("volume_count", *stencil_);
}

}  // namespace penumbra::shadow_volumes
