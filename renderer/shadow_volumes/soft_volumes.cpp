#include "renderer/shadow_volumes/soft_volumes.h"

#include <array>
#include <cmath>

#include "renderer/shadow_volumes/volume_draws.h"

namespace penumbra::shadow_volumes {
namespace {

/// Volumes over each other that overlap_counts.glsl tells apart at a point of the light.
constexpr std::size_t most_overlaps = 31;

/// CoverageBlock of coverage_table.glsl, before its values.
struct TableHead {
  static constexpr std::uint32_t point_count = 32;
  glm::uvec4 size{0u};
  glm::vec4 range{0.0f};
  std::array<glm::vec4, point_count> points{};
};

vulkan::Buffer upload_table(PrepareContext& context, std::uint32_t size) {
  const LightShape shape = shape_of(*context.light.source);
  const CoverageTable table = make_coverage_table(shape, size);
  TableHead head;
  const auto points = light_lattice(shape, TableHead::point_count);
  std::transform(points.begin(), points.end(), head.points.begin(),
                 [](const glm::dvec2& point) { return glm::vec4(point, 0.0, 0.0); });
  head.size = {table.size, table.directions, 0u, 0u};
  head.range.x = table.range;
  std::vector<std::byte> bytes(sizeof(head) + table.values.size() * sizeof(float));
  std::memcpy(bytes.data(), &head, sizeof(head));
  std::memcpy(bytes.data() + sizeof(head), table.values.data(),
              table.values.size() * sizeof(float));
  return upload(context.device, context.memory, "coverage table", bytes.data(), bytes.size(),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
}

}  // namespace

void SoftVolumes::draw(PrepareContext& context, const SoftVolumeOptions& options) {
  const glm::dvec3 half = extent_half_size(*context.light.source);
  const bool soft = half.x > 0.0 || half.y > 0.0;
  VolumeOptions hard;
  hard.clamp = options.clamp;
  hard.exact_sides = soft;
  hard.light_radius = extent_radius(*context.light.source);
  volumes_.draw(context, hard);
  unused_ = &context.geometry.position;
  if (!soft) return;
  if (!coverage_) create(context, options);
  if (options.count_overlaps && context.frame_index == 0 &&
      surely_crowds(context.scene, context.light, volume_triangles(context, false), most_overlaps))
    context.notes.push_back("more than " + std::to_string(most_overlaps) +
                            " volumes overlap: where their penumbrae do, they are wrong");
  draw_wedges(context, options.clamp);
}

void SoftVolumes::create(PrepareContext& context, const SoftVolumeOptions& options) {
  vulkan::ImageDescription description;
  description.format = options.format;
  description.width = context.geometry.width;
  description.height = context.geometry.height;
  description.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  coverage_ = vulkan::Image(context.device, context.memory, "wedge coverage", description);
  description.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  if (options.count_overlaps)
    for (vulkan::Image& counts : counts_)
      counts = vulkan::Image(context.device, context.memory, "overlap counts", description);
  table_ = upload_table(context, options.table_size);
}

void SoftVolumes::draw_wedges(PrepareContext& context, bool clamp) {
  vulkan::ProgramSource source = volume_program("renderer/shadow_volumes/wedge.geom", false);
  source.stages[VK_SHADER_STAGE_FRAGMENT_BIT] = "renderer/shadow_volumes/wedge.frag";
  vulkan::GraphicsState state;
  const bool counted = static_cast<bool>(counts_[0]);
  state.color_formats = {coverage_.description().format};
  if (counted) {
    source.preamble += "#define WITH_COUNTS\n";
    state.color_formats.resize(3, counts_[0].description().format);
  }
  state.depth_format = context.geometry.depth.description().format;
  state.vertex_input = vulkan::VertexInput::position;
  state.topology = volume_topology(false);
  // Faces that the camera sees from outside; a wedge that begins behind the surface is left out.
  state.depth_test = true;
  state.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
  state.depth_clamp = true;
  state.blend = vulkan::Blend::add;
  const vulkan::Pipeline& pipeline = context.pipelines.graphics(source, state);
  vulkan::Bindings bindings = context.frame_bindings;
  bindings.buffer("CoverageBlock", table_.whole());
  VolumeDrawOptions wanted;
  wanted.clamp = clamp;
  wanted.light_radius = extent_radius(*context.light.source);
  const VolumeDraws draws = list_volume_draws(context, wanted);
  vulkan::RenderTargets targets;
  targets.width = context.geometry.width;
  targets.height = context.geometry.height;
  targets.colors = {{coverage_.slice(0), true, {}}};
  if (counted)
    for (const vulkan::Image& counts : counts_)
      targets.colors.push_back({counts.slice(0), true, {}});
  targets.depth = context.geometry.depth.slice(0);
  targets.depth_format = state.depth_format;
  context.pass("wedges", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    commands.bind(pipeline, bindings);
    commands.cull(VK_CULL_MODE_BACK_BIT);
    draws.record(commands, context.scene);
    commands.end_rendering();
  });
}

void SoftVolumes::bind(vulkan::Bindings& bindings) const {
  volumes_.bind(bindings);
  const auto bind_image = [&](const char* name, const vulkan::Image& image) {
    bindings.texture(name, image ? image : *unused_, vulkan::Sampling::nearest);
  };
  bind_image("wedge_coverage", coverage_);
  bind_image("first_counts", counts_[0]);
  bind_image("second_counts", counts_[1]);
}

}  // namespace penumbra::shadow_volumes
