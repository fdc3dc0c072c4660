#include "renderer/shadow_maps/depth_map.h"

#include <algorithm>
#include <cmath>

#include "renderer/error.h"
#include "renderer/shadow_maps/bias/strategies.h"
#include "renderer/shadow_maps/views/light_view.h"

namespace penumbra::shadow_maps {

namespace {

/// `layout`, and what the layouts declare.
std::vector<Parameter> layout_parameters() {
  std::vector<Parameter> list;
  Parameter chosen;
  chosen.name = "layout";
  chosen.type = ParameterType::choice;
  chosen.default_value = std::string(default_layout);
  chosen.meaning = "Where depth lives.";
  chosen.variant = true;
  for (const Layout& layout : layouts()) {
    chosen.choices.push_back(layout.id);
    chosen.meaning += " " + layout.id + ": " + layout.meaning + ".";
    for (Parameter own : layout.parameters) {
      // Layouts may share a parameter: all of them declare it.
      const auto shared = std::find_if(list.begin(), list.end(),
                                       [&](const Parameter& p) { return p.name == own.name; });
      if (shared != list.end()) {
        shared->only_with->values.push_back(layout.id);
        continue;
      }
      own.only_with = Choices{chosen.name, {layout.id}};
      list.push_back(own);
    }
  }
  list.insert(list.begin(), chosen);
  return list;
}

Parameter range_parameter(const char* name, const char* meaning) {
  return real(name, 0.0, {0.0, 1e6}, meaning).in("m");
}

}  // namespace

std::vector<Parameter> map_parameters() {
  std::vector<Parameter> list;
  list.push_back(integer("map_size", 512, {1, 16384},
                         "Width and height of the shadow map; layouts of tiles have sizes of their "
                         "own.")
                     .log()
                     .in("texels"));
  for (const Parameter& parameter : layout_parameters()) list.push_back(parameter);

  list.push_back(choice(
      "range", "boxes", {"boxes", "visible", "fixed"},
      "Where the map's range of depth lies. boxes: from the nearest caster's box to the farthest "
      "receiver's. visible: from the nearest to the farthest place that the camera sees and that "
      "faces the light, with casters before it clamped onto near. fixed: from the light to the end "
      "of the scene."));
  for (const Parameter& parameter : bias_parameters()) list.push_back(parameter);
  return list;
}

std::vector<Parameter> comparing_map_parameters() {
  std::vector<Parameter> list = map_parameters();
  list.push_back(choice("depth", "linear", {"linear", "hyperbolic"},
                        "How distances share the map's numbers. linear: evenly. hyperbolic: evenly "
                        "in 1/z, as a projection has it, so that few are left far from the light; "
                        "directional lights have no such.")
                     .compiled());
  list.push_back(choice("depth_bits", "32", {"32", "16"},
                        "What a depth is kept in: a float of 32 bits, or one of 65,536 steps.")
                     .compiled());
  list.push_back(real("bias_units", 0.0, {0.0, 1e6},
                      "Steps of the map's numbers granted to every comparison, beside bias: of "
                      "2^-24 as in a map of 24 bits, with 16 bits of 1/65535. 0: as many as "
                      "rounding needs."));
  list.push_back(range_parameter(
      "near",
      "Distance along the light's axis at which the map's range begins, for a directional light "
      "from the scene's box on. 0: fitted to the scene. Receivers before it are lit."));
  list.push_back(range_parameter("far",
                                 "Distance at which the range ends. 0: fitted to the scene. What "
                                 "lies behind it casts no shadow."));
  return list;
}

std::vector<Diagnostic> map_diagnostics(const std::vector<Diagnostic>& own) {
  std::vector<Diagnostic> list = {
      {"map",
       "The depth map's first view as the light sees it, or all tiles side by side: near is dark, "
       "far is bright."},
      {"tiles",
       "All views side by side. The frame of each tells its texels along a side: red 1024, yellow "
       "256, green 128, cyan 64, blue 16. Within, how bright tells how much a tile matters."},
      {"views",
       "Which view of the map tells of each pixel, by colour: red, yellow, green, cyan, blue, "
       "magenta, orange, grey, and other hues of tiles; mixed where two do, dark in shadow, black "
       "where none does."},
      {"texels-per-pixel",
       "Texels of the map along the longer side of what a pixel covers, by colour: green 1, yellow "
       "1/4, red 1/16 and fewer (the map is coarser than the picture), cyan 4, blue 16 and more; "
       "black where no view tells."}};
  list.insert(list.end(), own.begin(), own.end());
  return list;
}

namespace {

/// Of the two surfaces that some bias strategies tell apart.
constexpr VkFormat layer_format = VK_FORMAT_D32_SFLOAT;

/// What the views of a map draw; what touches several is drawn as often.
void note_drawn(PrepareContext& context, const std::vector<DrawnCasters>& drawn) {
  if (drawn.size() < 2) return;
  std::string triangles, casters;
  for (const DrawnCasters& view : drawn) {
    const char* comma = triangles.empty() ? "" : ", ";
    triangles += comma + std::to_string(view.triangles);
    casters += comma + std::to_string(view.ranges);
  }
  context.notes.push_back("light " + context.input.light.name +
                          ": the views of its map draw triangles: " + triangles +
                          "; casters, each material of an instance by itself: " + casters);
}

/// Fits ranges to what is seen, for filters that bear casters clamped onto near.
void see_ranges(PrepareContext& context, std::vector<shader::MapView>& views, const MapUse& use,
                const std::function<std::vector<Bounds>(const std::vector<shader::MapView>&, bool)>&
                    seen_bounds) {
  const std::string light = "light " + context.input.light.name + ": ";
  if (use.follows_extent) {
    context.notes.push_back(light +
                            "range visible would lose the blockers' distances, which penumbrae "
                            "follow: boxes is kept");
    return;
  }
  if (use.common_range)
    context.notes.push_back(light +
                            "casters before what is seen are clamped onto near, which changes "
                            "what the filter averages");
  const ParameterValues& parameters = context.input.parameters;
  fit_ranges_to(views, seen_bounds(views, false), use, real_of(parameters, "slope_scale"),
                real_of(parameters, "bias"),
                static_cast<double>(integer_of(parameters, "map_size")));
}

VkFormat depth_format(const ParameterValues& parameters) {
  const bool compact =
      parameters.contains("depth_bits") && choice_of(parameters, "depth_bits") == "16";
  return compact ? VK_FORMAT_D16_UNORM : VK_FORMAT_D32_SFLOAT;
}

/// Whether the rasteriser comes to the depths that are kept: affine in the map's plane, and moved
/// by no more than rounding needs, whatever the facet.
bool interpolates_depth(const TechniqueInput& input, const std::vector<shader::MapView>& views) {
  const ParameterValues& parameters = input.parameters;
  if (real_of(parameters, "bias") > 0.0 || chosen_strategy(parameters).moves_facets) return false;
  const bool hyperbolic =
      parameters.contains("depth") && choice_of(parameters, "depth") == "hyperbolic";
  return std::all_of(views.begin(), views.end(), [&](const shader::MapView& view) {
    const bool perspective = view.origin.w > 0.5f;
    const bool counted_from_scene = view.right.w != 0.0f;
    const bool warped = view.unwarp[0].z != 0.0f || view.unwarp[1].z != 0.0f;
    return !warped && (!perspective || (hyperbolic && !counted_from_scene));
  });
}

}  // namespace

bool keeps_image(const ParameterValues& parameters) {
  return chosen_layout(parameters).ranking == TileRanking::none;
}

void require_image(const TechniqueInput& input, const std::string& needed) {
  if (!keeps_image(input.parameters))
    throw unsupported(
        "layout " + chosen_layout(input.parameters).id + " keeps its depths in a buffer, " + needed,
        "layout");
}

std::uint32_t view_count(const TechniqueInput& input) {
  return chosen_layout(input.parameters).view_count(input);
}

void DepthMap::require(const TechniqueInput& input, Requirements& needs) {
  const Layout& layout = chosen_layout(input.parameters);
  require_served(layout, input.light);
  needs.definitions += view_definitions(input);
  needs.reads_sky = false;
  if (layout.ranking != TileRanking::none) {
    if (knows_two_surfaces(input.parameters))
      throw unsupported("layout " + layout.id + " keeps one surface; bias_strategy " +
                            chosen_strategy(input.parameters).id + " needs two",
                        "bias_strategy");
    Tiles::require(input, layout.ranking, needs);
    return;
  }
  const auto size = static_cast<std::uint32_t>(integer_of(input.parameters, "map_size"));
  const std::uint64_t texels = std::uint64_t{size} * size * view_count(input);
  needs.memory.push_back({"shadow map",
                          texels * vulkan::texel_bytes(depth_format(input.parameters)), size,
                          "map_size"});
  if (layout.reads_samples || choice_of(input.parameters, "range") == "visible")
    SeenSamples::require(input, needs);
  if (!knows_two_surfaces(input.parameters)) return;
  for (const char* layer : {"first depths", "second depths"})
    needs.memory.push_back({layer, texels * vulkan::texel_bytes(layer_format), size, "map_size"});
}

DepthMap::Views DepthMap::fit_views(PrepareContext& context, const MapUse& use) {
  const ParameterValues& parameters = context.input.parameters;
  const auto size = static_cast<std::uint32_t>(integer_of(parameters, "map_size"));
  seen_.forget();
  const auto seen = [&](const Views& asked, bool by_depth) {
    return seen_.bounds(context, asked, by_depth);
  };
  Views views = chosen_layout(parameters)
                    .fit({context.scene, context.input.scene_box, context.light, context.fit,
                          context.picture_camera, parameters, use, size, seen, context.notes});
  if (choice_of(parameters, "range") == "fixed")
    fix_ranges(views, context.scene, context.fit);
  else if (choice_of(parameters, "range") == "visible" && keeps_image(parameters))
    see_ranges(context, views, use, seen);
  return views;
}

void DepthMap::draw(PrepareContext& context, const MapUse& use) {
  const ParameterValues& parameters = context.input.parameters;
  const auto size = static_cast<std::uint32_t>(integer_of(parameters, "map_size"));
  Views views = fit_views(context, use);
  check_views(context.input, views);
  const auto slope_scale = static_cast<float>(real_of(parameters, "slope_scale"));
  for (shader::MapView& view : views) {
    set_given_range(view, parameters);
    count_from_scene(view, context.scene, parameters);
    // Positions are floats: this much is lost on the way to a depth.
    const float rounding = std::ldexp(view.range.y, -21);
    view.range.w = static_cast<float>(real_of(parameters, "bias")) + slope_scale * rounding;
  }
  note_open_casters(context);
  if (!keeps_image(parameters)) {
    constants_ = tiles_.rank(context, views, use, seen_);
    note_drawn(context, tiles_.draw(context, constants_));
    return;
  }
  if (!image_) {
    vulkan::ImageDescription description;
    description.format = depth_format(parameters);
    description.width = description.height = size;
    description.layers = static_cast<std::uint32_t>(views.size());
    description.array_view = true;
    description.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    image_ = vulkan::Image(context.device, context.memory, "shadow map", description);
  }
  shader::MapData data{};
  std::copy(views.begin(), views.end(), data.views);
  data.texel = {static_cast<float>(size), static_cast<float>(use.kernel_radius),
                static_cast<float>(views.size()), slope_scale};
  constants_ = context.constants.push(data);

  if (knows_two_surfaces(parameters))
    draw_layers(context, views);
  else
    draw_casters(context, views, image_, "");
}

void DepthMap::draw_casters(PrepareContext& context, const Views& views,
                            const vulkan::Image& target, const std::string& layer) const {
  CasterProgram program;
  program.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shadow_maps/depth_map.vert"},
                    {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shadow_maps/depth_map.frag"}};
  program.preamble = context.declarations + layer;
  program.state.depth_format = target.description().format;
  program.state.depth_test = program.state.depth_write = true;
  program.state.depth_compare = VK_COMPARE_OP_LESS;
  program.state.depth_clamp = std::none_of(views.begin(), views.end(), cuts_casters);
  if (layer.empty() && program.state.depth_clamp && interpolates_depth(context.input, views)) {
    program.preamble += "#define INTERPOLATED_DEPTH\n";
    program.shades_holes_alone = true;
  }
  if (chosen_strategy(context.input.parameters).surfaces == MapSurfaces::back_faces)
    program.cull = VK_CULL_MODE_FRONT_BIT;
  program.first_surface_alone =
      program.state.depth_clamp && keeps_first_surfaces(context.input.parameters);

  std::vector<DrawnCasters> drawn;
  context.pass("shadow map", [&](vulkan::Commands& commands) {
    for (std::uint32_t view = 0; view < views.size(); ++view) {
      vulkan::RenderTargets targets;
      targets.width = targets.height = target.description().width;
      targets.depth = target.slice(view);
      targets.depth_format = target.description().format;
      targets.clear_depth = true;
      targets.depth_clear_value = 1.0f;
      vulkan::Bindings bindings;
      bindings.buffer("MapViewBlock", context.constants.push(views[view]));
      bindings.buffer("MapBlock", constants_);
      if (&target == &second_)
        bindings.texture_slice("first_depths", first_, view, 0, vulkan::Sampling::nearest);
      commands.begin_rendering(targets);
      drawn.push_back(
          context.draw_casters(commands, program, bindings, views[view].clip_from_world));
      commands.end_rendering();
    }
  });
  note_drawn(context, drawn);
}

void DepthMap::draw_layers(PrepareContext& context, const Views& views) {
  if (!first_) {
    vulkan::ImageDescription layer = image_.description();
    layer.format = layer_format;
    first_ = vulkan::Image(context.device, context.memory, "first depths", layer);
    second_ = vulkan::Image(context.device, context.memory, "second depths", layer);
  }
  draw_casters(context, views, first_, "#define LAYER\n");
  draw_casters(context, views, second_, "#define LAYER\n#define SECOND_LAYER\n");

  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shadow_maps/bias/layered_depths.frag"}};
  source.preamble = context.declarations;
  vulkan::GraphicsState state;
  state.depth_format = image_.description().format;
  state.depth_test = state.depth_write = true;
  state.depth_compare = VK_COMPARE_OP_ALWAYS;
  const vulkan::Pipeline& pipeline = context.pipelines.graphics(source, state);
  vulkan::Bindings bindings = context.frame_bindings;  // bias_units is no constant
  bindings.buffer("MapBlock", constants_);
  bindings.texture("first_depths", first_, vulkan::Sampling::nearest);
  bindings.texture("second_depths", second_, vulkan::Sampling::nearest);
  context.pass("layers of depth", [&](vulkan::Commands& commands) {
    for (std::uint32_t view = 0; view < views.size(); ++view) {
      vulkan::RenderTargets targets;
      targets.width = targets.height = image_.description().width;
      targets.depth = image_.slice(view);
      targets.depth_format = image_.description().format;
      commands.begin_rendering(targets);
      commands.bind(pipeline, bindings);
      commands.constants(view);
      commands.full_screen_triangle();
      commands.end_rendering();
    }
  });
}

void DepthMap::bind(vulkan::Bindings& bindings, vulkan::Sampling sampling) const {
  if (image_)
    bindings.texture("shadow_map", image_, sampling);
  else
    tiles_.bind(bindings);
  bindings.buffer("MapBlock", constants_);
}

}  // namespace penumbra::shadow_maps
