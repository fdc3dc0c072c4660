#include "renderer/shadow_maps/texels/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "renderer/error.h"
#include "renderer/shadow_maps/bias/strategies.h"
#include "renderer/shadow_maps/views/light_view.h"
#include "renderer/shadow_maps/views/place_tiles.h"

namespace penumbra::shadow_maps {
namespace {

constexpr std::uint32_t tiles = shader::tile_count;

std::uint64_t texels_of_tiles() {
  return std::accumulate(
      std::begin(shader::tile_sizes), std::end(shader::tile_sizes), std::uint64_t{0},
      [](std::uint64_t sum, int size) { return sum + std::uint64_t(size) * std::uint64_t(size); });
}

constexpr VkDeviceSize sums_bytes = tiles * sizeof(shader::TileSums);
constexpr VkDeviceSize ranked_bytes = sizeof(shader::MapData);

TileRanking ranking_of(const PrepareContext& context) {
  return chosen_layout(context.input.parameters).ranking;
}

/// Whether tiles that show nothing are left as they are. A filter that reads over a border needs
/// its neighbour, and what the last frame saw says nothing of this one.
bool skips_empty(const MapUse& use, TileRanking ranking) {
  return use.kernel_radius == 0.0 && !use.follows_extent && ranking != TileRanking::previous_frame;
}

/// What a comparison grants is left before the nearest place seen: casters there are clamped.
shader::TileRules rules_for(const PrepareContext& context, const MapUse& use, std::uint64_t samples,
                            double radius) {
  const ParameterValues& parameters = context.input.parameters;
  const double gain = real_of(parameters, "importance_gain");
  const double range = real_of(parameters, "importance_range");
  const double slope_scale = real_of(parameters, "slope_scale");
  const double bias = real_of(parameters, "bias");
  shader::TileRules rules{};
  rules.importance = {std::ldexp(1.0, importance_scale(samples, gain)), gain,
                      range > 0.0 ? range : radius, 0.0};
  rules.granted = {bias, 3.0 * (1.0 + use.kernel_radius) * slope_scale, bias,
                   slope_scale * std::ldexp(1.0, -21)};
  rules.options = {ranges_follow_samples(parameters, use) ? 1u : 0u,
                   skips_empty(use, ranking_of(context)) ? 1u : 0u,
                   choice_of(parameters, "tile_sizes") == "proportional"
                       // Each tile has one at least.
                       ? static_cast<std::uint32_t>(texels_of_tiles()) - tiles
                       : 0u,
                   0u};
  return rules;
}

shader::MapData map_data(const PrepareContext& context, const std::vector<shader::MapView>& views,
                         const MapUse& use) {
  shader::MapData data{};
  std::copy(views.begin(), views.end(), data.views);
  data.texel = {static_cast<float>(shader::largest_tile), static_cast<float>(use.kernel_radius),
                static_cast<float>(views.size()),
                static_cast<float>(real_of(context.input.parameters, "slope_scale"))};
  return data;
}

bool is_seen(const shader::TileSums& sums) {
  return sums.seen.z != 0u;
}

/// Texels along a side for a share of all importance.
std::uint32_t proportional_side(float share, std::uint32_t texels) {
  const float side = std::sqrt(share * static_cast<float>(texels));
  return std::clamp(static_cast<std::uint32_t>(side), 1u, std::uint32_t{shader::largest_tile});
}

/// The same as tile_ranks.comp.
void apply(const std::array<shader::TileSums, tiles>& sums, const shader::TileRules& rules,
           std::vector<shader::MapView>& views) {
  std::array<std::uint32_t, tiles> importance{};
  for (std::size_t i = 0; i < tiles; ++i) importance[i] = sums[i].seen.x;
  const auto ranks = tile_ranks(importance);
  const float most =
      std::max(static_cast<float>(*std::max_element(importance.begin(), importance.end())), 1.0f);
  float all = 0.0f;
  for (const std::uint32_t own : importance) all += static_cast<float>(own);
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < tiles; ++i) {
    shader::MapView& view = views[i];
    auto size = static_cast<std::uint32_t>(shader::tile_sizes[ranks[i]]);
    if (rules.options.z != 0u)
      size = proportional_side(static_cast<float>(importance[i]) / std::max(all, 1.0f),
                               rules.options.z);
    view.texels = {static_cast<float>(size), static_cast<float>(first), 0.0f, 0.0f};
    first += size * size;
    view.forward.w = 2.0f * glm::length(glm::vec3(view.right)) / view.texels.x;
    const bool seen = is_seen(sums[i]);
    view.choice = {seen || rules.options.y == 0u ? 1.0f : 0.0f,
                   static_cast<float>(importance[i]) / most, static_cast<float>(ranks[i]), 0.0f};
    if (seen && rules.options.x != 0u) {
      const float granted = rules.granted.x + rules.granted.y * view.forward.w;
      set_fitted_range(view, double{float_at_place(~sums[i].seen.y)} - double{granted},
                       double{float_at_place(sums[i].seen.z)});
    }
    view.range.w = rules.granted.z + rules.granted.w * view.range.y;
  }
}

void note_tiles(PrepareContext& context, const std::vector<shader::MapView>& views,
                const std::array<shader::TileSums, tiles>& sums, const shader::TileRules& rules) {
  std::string sizes, importance;
  for (std::size_t i = 0; i < tiles; ++i) {
    const char* comma = i == 0 ? "" : ", ";
    sizes += comma + std::to_string(static_cast<int>(views[i].texels.x));
    importance += comma + to_text(std::round(double{static_cast<float>(sums[i].seen.x)} /
                                             double{rules.importance.x}));
  }
  context.notes.push_back("light " + context.input.light.name + ": its tiles have texels a side: " +
                          sizes + "; importance: " + importance);
}

}  // namespace

int importance_scale(std::uint64_t samples, double gain) {
  int scale = 31;
  while (std::ldexp((1.0 + gain) * static_cast<double>(samples), scale) >= std::ldexp(1.0, 32))
    --scale;
  return scale;
}

std::array<std::uint32_t, shader::tile_count> tile_ranks(
    std::span<const std::uint32_t, shader::tile_count> importance) {
  std::array<std::uint32_t, tiles> order{}, ranks{};
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return importance[a] > importance[b]; });
  for (std::uint32_t rank = 0; rank < tiles; ++rank) ranks[order[rank]] = rank;
  return ranks;
}

void Tiles::require(const TechniqueInput& input, TileRanking ranking, Requirements& needs) {
  needs.memory.push_back({"shadow map", texels_of_tiles() * sizeof(std::uint32_t), 0, "layout"});
  needs.memory.push_back({"importance of tiles", sums_bytes, 0, "layout"});
  if (ranking == TileRanking::on_device)
    needs.memory.push_back({"views of tiles", ranked_bytes, 0, "layout"});
  SeenSamples::require(input, needs);
}

void Tiles::allocate(PrepareContext& context, TileRanking ranking) {
  if (texels_) return;
  const bool on_device = ranking == TileRanking::on_device;
  constexpr VkBufferUsageFlags cleared =
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  texels_ = {context.device, context.memory, "shadow map",
             texels_of_tiles() * sizeof(std::uint32_t), cleared};
  sums_ = {context.device,
           context.memory,
           "importance of tiles",
           sums_bytes,
           cleared,
           on_device ? vulkan::MemoryKind::device : vulkan::MemoryKind::readback};
  if (on_device)
    ranked_ = {context.device, context.memory, "views of tiles", ranked_bytes,
               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT};
}

void Tiles::measure(PrepareContext& context, const shader::MapData& placed,
                    const vulkan::BufferRange& rules, SeenSamples& samples) {
  const vulkan::Image& positions = samples.positions(context);
  vulkan::Bindings bindings = context.frame_bindings;
  bindings.buffer("MapBlock", context.constants.push(placed));
  bindings.buffer("TileRulesBlock", rules);
  bindings.buffer("TileSumsBlock", sums_.whole());
  bindings.texture("seen_positions", positions, vulkan::Sampling::nearest);
  const vulkan::Pipeline& pipeline =
      context.pipelines.compute("renderer/shadow_maps/texels/tile_importance.comp");
  const vulkan::ImageDescription& grid = positions.description();
  context.pass("importance of tiles", [&](vulkan::Commands& commands) {
    vkCmdFillBuffer(commands.handle(), sums_.handle(), 0, VK_WHOLE_SIZE, 0);
    commands.barrier();
    commands.bind(pipeline, bindings);
    // Groups of 8 x 8 invocations, each of which goes through a block of 8 x 8 samples.
    commands.dispatch((grid.width + 63) / 64, (grid.height + 63) / 64);
  });
  measured_ = true;
}

Tiles::Sums Tiles::read() const {
  Sums sums;
  std::memcpy(sums.data(), sums_.mapped(), sizeof(sums));
  return sums;
}

/// What the last frame saw; its own in the first. A frame may be drawn in windows, which must
/// agree, so that a frame is told by its number and its camera.
Tiles::Sums Tiles::sums_of_previous(PrepareContext& context,
                                    const std::function<void()>& measure_now) {
  const bool begins = !measured_ || frame_ != context.frame_index ||
                      camera_ != context.picture_camera.clip_from_world;
  if (begins) {
    const bool first = !measured_;
    if (!first) previous_ = read();  // the fence of that frame has passed
    measure_now();
    if (first) {
      context.recorder.flush();
      previous_ = read();
    }
  }
  frame_ = context.frame_index;
  camera_ = context.picture_camera.clip_from_world;
  return previous_;
}

vulkan::BufferRange Tiles::rank_on_device(PrepareContext& context, const shader::MapData& placed,
                                          const vulkan::BufferRange& rules) {
  vulkan::Bindings bindings;
  bindings.buffer("MapBlock", context.constants.push(placed));
  bindings.buffer("TileRulesBlock", rules);
  bindings.buffer("TileSumsBlock", sums_.whole());
  bindings.buffer("RankedMapBlock", ranked_.whole());
  const vulkan::Pipeline& pipeline =
      context.pipelines.compute("renderer/shadow_maps/texels/tile_ranks.comp");
  context.pass("ranks of tiles", [&](vulkan::Commands& commands) {
    commands.bind(pipeline, bindings);
    commands.dispatch(1);
  });
  return ranked_.whole();
}

vulkan::BufferRange Tiles::rank(PrepareContext& context, std::vector<shader::MapView> views,
                                const MapUse& use, SeenSamples& samples) {
  const TileRanking ranking = ranking_of(context);
  allocate(context, ranking);
  placed_ = views;
  const double radius = 4.0 * double{glm::length(glm::vec3(views.front().right))};
  const vulkan::ImageDescription& grid = samples.positions(context).description();
  const shader::TileRules rules =
      rules_for(context, use, std::uint64_t{grid.width} * grid.height, radius);
  const vulkan::BufferRange pushed = context.constants.push(rules);
  const shader::MapData placed = map_data(context, views, use);
  const auto measure_now = [&] { measure(context, placed, pushed, samples); };
  drawn_.assign(tiles, true);
  if (ranking == TileRanking::on_device) {
    measure_now();
    return rank_on_device(context, placed, pushed);
  }
  Sums sums;
  if (ranking == TileRanking::previous_frame) {
    sums = sums_of_previous(context, measure_now);
  } else {
    measure_now();
    context.recorder.flush();
    sums = read();
  }
  apply(sums, rules, views);
  note_tiles(context, views, sums, rules);
  for (std::size_t i = 0; i < tiles; ++i) drawn_[i] = views[i].choice.x > 0.0f;
  return context.constants.push(map_data(context, views, use));
}

std::vector<DrawnCasters> Tiles::draw(PrepareContext& context,
                                      const vulkan::BufferRange& map) const {
  const ParameterValues& parameters = context.input.parameters;
  CasterProgram program;
  program.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shadow_maps/depth_map.vert"},
                    {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shadow_maps/depth_map.frag"}};
  program.preamble = context.declarations + "#define TILE\n";
  program.state.depth_clamp = true;
  program.cull_by_spheres = choice_of(parameters, "tile_culling") == "spheres";
  if (chosen_strategy(parameters).surfaces == MapSurfaces::back_faces)
    program.cull = VK_CULL_MODE_FRONT_BIT;
  program.first_surface_alone = keeps_first_surfaces(parameters);
  std::vector<DrawnCasters> drawn(tiles);
  context.pass("shadow map", [&](vulkan::Commands& commands) {
    // 0 is far: lit.
    vkCmdFillBuffer(commands.handle(), texels_.handle(), 0, VK_WHOLE_SIZE, 0);
    commands.barrier();
    // Every tile is drawn in one corner of the same area: its size may be known to the device
    // alone.
    vulkan::RenderTargets targets;
    targets.width = targets.height = shader::largest_tile;
    commands.begin_rendering(targets);
    for (std::uint32_t tile = 0; tile < tiles; ++tile) {
      if (!drawn_[tile]) continue;
      vulkan::Bindings bindings;
      bindings.buffer("MapBlock", map);
      bindings.buffer("MapTexelBlock", texels_.whole());
      bindings.buffer("TileBlock", context.constants.push(glm::uvec4(tile, 0u, 0u, 0u)));
      drawn[tile] =
          context.draw_casters(commands, program, bindings, placed_[tile].clip_from_world);
    }
    commands.end_rendering();
  });
  return drawn;
}

void Tiles::bind(vulkan::Bindings& bindings) const {
  bindings.buffer("MapTexelBlock", texels_.whole());
}

}  // namespace penumbra::shadow_maps
