#include <iomanip>
#include <sstream>

#include "renderer/shadow_maps/depth_map.h"
#include "renderer/shadow_volumes/stencil_volumes.h"

namespace penumbra::techniques {
namespace {

constexpr VkFormat mask_format = VK_FORMAT_R8_UNORM;

/// Hard shadows from a map, but for samples at its silhouettes: there volumes are counted.
class Hybrid : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    shadow_maps::DepthMap::require(input, needs);
    needs.reads_sky = true;
    needs.stencil = true;
    needs.adjacency = true;
  }

  void prepare(PrepareContext& context) override {
    if (!mask_) create(context);
    map_.draw(context, {.kernel_radius = reach(context)});
    draw_mask(context);
    mark_silhouettes(context);
    shadow_volumes::VolumeOptions options =
        shadow_volumes::volume_options(context.input.parameters);
    options.masked = true;
    volumes_.draw(context, options);
    if (context.frame_index == 0) note_shares(context, options);
  }

  void bind(vulkan::Bindings& bindings) const override {
    volumes_.bind(bindings);
    bindings.texture("hybrid_mask", mask_, vulkan::Sampling::nearest);
  }

 private:
  static double reach(const PrepareContext& context) {
    return static_cast<double>(integer_of(context.input.parameters, "reach"));
  }

  void create(PrepareContext& context) {
    vulkan::ImageDescription description;
    description.format = mask_format;
    description.width = context.geometry.width;
    description.height = context.geometry.height;
    description.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    mask_ = vulkan::Image(context.device, context.memory, "hybrid mask", description);
    counts_ = vulkan::Buffer(context.device, context.memory, "sample counts",
                             count_places * sizeof(std::uint32_t),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, vulkan::MemoryKind::readback);
    std::memset(counts_.mapped(), 0, counts_.size());
  }

  static vulkan::RenderTargets targets_of(const PrepareContext& context) {
    vulkan::RenderTargets targets;
    targets.width = context.geometry.width;
    targets.height = context.geometry.height;
    return targets;
  }

  void draw_mask(PrepareContext& context) {
    vulkan::ProgramSource source;
    source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                     {VK_SHADER_STAGE_FRAGMENT_BIT, "techniques/hybrid/mask.frag"}};
    source.preamble = context.declarations + "#define PASSES_LIGHT\n";
    source.constants_from_vertex = context.device.reads_blocks_by_lane();
    if (context.frame_index == 0) source.preamble += "#define COUNT_SAMPLES\n";
    vulkan::Bindings bindings = context.frame_bindings;
    map_.bind(bindings);
    if (bindings.entries().contains("MapBlock")) source.preamble += "#define PASSES_MAP\n";
    vulkan::GraphicsState state;
    state.color_formats = {mask_format};
    const vulkan::Pipeline& pipeline = context.pipelines.graphics(source, state);
    bindings.buffer("SampleCountBlock", counts_.whole());
    vulkan::RenderTargets targets = targets_of(context);
    targets.colors = {{mask_.slice(0), false, {}}};
    context.pass("silhouette mask", [&](vulkan::Commands& commands) {
      commands.begin_rendering(targets);
      commands.bind(pipeline, bindings);
      commands.full_screen_triangle();
      commands.end_rendering();
    });
  }

  void mark_silhouettes(PrepareContext& context) {
    vulkan::ProgramSource source;
    source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                     {VK_SHADER_STAGE_FRAGMENT_BIT, "techniques/hybrid/mark.frag"}};
    vulkan::RenderTargets targets = targets_of(context);
    targets.depth = context.geometry.depth.slice(0);
    targets.depth_format = context.geometry.depth.description().format;
    targets.clear_stencil = true;
    vulkan::GraphicsState state;
    state.depth_format = targets.depth_format;
    state.stencil_test = true;
    state.stencil_front.pass = VK_STENCIL_OP_REPLACE;
    state.stencil_front.reference = shadow_volumes::mask_bit;
    state.stencil_back = state.stencil_front;
    const vulkan::Pipeline& pipeline = context.pipelines.graphics(source, state);
    vulkan::Bindings bindings = context.frame_bindings;
    bindings.texture("hybrid_mask", mask_, vulkan::Sampling::nearest);
    context.pass("silhouette mask", [&](vulkan::Commands& commands) {
      commands.begin_rendering(targets);
      commands.bind(pipeline, bindings);
      commands.full_screen_triangle();
      commands.end_rendering();
    });
  }

  /// Says, from the first frame, what shares of the samples that face the light and of the volumes'
  /// fragments the volumes have to do with.
  void note_shares(PrepareContext& context, shadow_volumes::VolumeOptions options) {
    volumes_.count_fragments(context, options, counts_.whole(), 2);
    options.masked = false;
    volumes_.count_fragments(context, options, counts_.whole(), 3);
    context.recorder.flush();
    std::uint32_t counts[count_places];
    std::memcpy(counts, counts_.mapped(), sizeof(counts));
    const auto share = [](std::uint32_t part, std::uint32_t whole) {
      std::ostringstream text;
      text << std::fixed << std::setprecision(2) << 100.0 * part / std::max(whole, 1u) << " %";
      return text.str();
    };
    context.notes.push_back("light " + context.input.light.name + ": volumes decide " +
                            share(counts[1], counts[0]) + " of the samples that face it and draw " +
                            share(counts[2], counts[3]) + " of their fragments");
  }

  /// Samples, samples at silhouettes, fragments drawn, fragments without the mask.
  static constexpr std::size_t count_places = 4;

  shadow_maps::DepthMap map_;
  shadow_volumes::StencilVolumes volumes_;
  vulkan::Image mask_;
  vulkan::Buffer counts_;
};

}  // namespace

TechniqueDescription describe_hybrid() {
  const Parameter reach = integer("reach", 1, {1, 8},
                                  "A sample is at a silhouette where the 2 reach by 2 reach texels "
                                  "around its place disagree.")
                              .in("texels")
                              .compiled();

  TechniqueDescription description;
  description.label = "Hybrid";
  description.title = "Shadow map with volumes at silhouettes";
  description.family = "hybrid";
  description.source = "Sindholt 2005, 5; Chan and Durand 2004";
  description.parameters = shadow_maps::map_parameters();
  description.parameters.push_back(reach);
  for (const Parameter& parameter : shadow_volumes::volume_parameters())
    description.parameters.push_back(parameter);
  description.diagnostics = {
      {"mask",
       "The map's answer in grey; in colour the samples that volumes decide: yellow lit, red "
       "dark."}};
  description.create = create_technique<Hybrid>;
  return description;
}

}  // namespace penumbra::techniques
