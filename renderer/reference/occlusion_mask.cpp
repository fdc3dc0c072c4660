#include "renderer/reference/occlusion_mask.h"

#include <algorithm>
#include <cmath>

namespace penumbra::reference {
namespace {

constexpr auto batch_size = static_cast<std::uint32_t>(shader::points_per_batch);

/// Distance of a receiver from its facet, per metre of the scene's diagonal: rounding of positions
/// is below 1e-6 of it.
constexpr float receiver_offset = 2e-5f;

struct Box {
  glm::dvec3 low, high;
};

/// Box around the whole extent: positions, or directions of any length.
Box extent_box(const WorldLight& light) {
  const bool directional = light.kind == LightKind::directional;
  glm::dvec3 half = extent_half_size(*light.source);
  if (directional) half = glm::tan(glm::radians(half));
  // Seen from far away a sphere is a disc.
  if (directional) half.z = 0.0;
  const glm::dvec3 reach = glm::abs(light.right) * half.x + glm::abs(light.up) * half.y +
                           glm::abs(light.direction) * half.z;
  const glm::dvec3 middle = directional ? -light.direction : light.position;
  return {middle - reach, middle + reach};
}

/// Widens a box by what rounding of points and receivers may do.
void widen(Box& box, bool directional, const GpuScene& scene) {
  double reach = 1.0;
  if (!directional) {
    const glm::dvec3 far =
        glm::max(glm::max(glm::abs(box.low), glm::abs(box.high)),
                 glm::dvec3(glm::max(glm::abs(scene.low()), glm::abs(scene.high()))));
    reach = std::max({far.x, far.y, far.z});
  }
  box.low -= 1e-6 * reach;
  box.high += 1e-6 * reach;
}

/// For the points of one sample of a pixel.
shader::ShaftData shaft_data(const PrepareContext& context, std::uint32_t set) {
  shader::ShaftData data{};
  const bool directional = context.light.kind == LightKind::directional;
  const auto points = context.points.subspan(std::size_t{set} * batch_size, batch_size);
  Box batch{glm::dvec3(points.front()), glm::dvec3(points.front())};
  for (std::uint32_t i = 0; i < batch_size; ++i) {
    data.points[i] = points[i];
    if (i >= context.points_in_batch) continue;
    batch.low = glm::min(batch.low, glm::dvec3(points[i]));
    batch.high = glm::max(batch.high, glm::dvec3(points[i]));
  }
  Box whole = extent_box(context.light);
  widen(batch, directional, context.scene);
  widen(whole, directional, context.scene);
  const float diagonal = glm::length(context.scene.high() - context.scene.low());
  data.box_low = glm::vec4(batch.low, directional ? 0.0 : 1.0);
  data.box_high = glm::vec4(batch.high, receiver_offset * diagonal);
  data.whole_low = glm::vec4(whole.low, glm::length(extent_half_size(*context.light.source)));
  data.whole_high = glm::vec4(whole.high, 0.0);
  data.unused.x = context.points_in_batch < batch_size ? ~0u << context.points_in_batch : 0u;
  return data;
}

vulkan::Image make_image(PrepareContext& context, const char* name, std::uint32_t layers) {
  vulkan::ImageDescription description;
  description.format = VK_FORMAT_R32_UINT;
  description.width = context.geometry.width;
  description.height = context.geometry.height;
  description.layers = layers;
  description.usage =
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return {context.device, context.memory, name, description};
}

}  // namespace

void OcclusionMask::trace(PrepareContext& context) {
  const bool with_candidates = context.batches > 1;
  if (!mask_) create_images(context, with_candidates);
  if (with_candidates && context.batch == 0)
    dispatch(context, "find occluders", "#define FIND_CANDIDATES\n", false);
  dispatch(context, "occlusion mask", "", with_candidates);
}

void OcclusionMask::create_images(PrepareContext& context, bool with_candidates) {
  mask_ = make_image(context, "occlusion mask", 1);
  if (with_candidates) candidates_ = make_image(context, "occluder range", 2);
}

void OcclusionMask::dispatch(PrepareContext& context, const std::string& name,
                             const std::string& preamble, bool has_candidates) {
  const Intersector& intersector = Intersector::of(context.device, context.scene);
  std::string defines = preamble;
  if (intersector.has_holes()) defines += "#define WITH_HOLES\n";
  if (has_candidates) defines += "#define WITH_CANDIDATES\n";
  const vulkan::Pipeline& pipeline =
      context.pipelines.compute("renderer/reference/occlusion_mask.comp", defines);
  vulkan::Bindings bindings = context.frame_bindings;
  intersector.bind(bindings);
  bindings.storage_image("occlusion_mask", mask_);
  if (candidates_) bindings.storage_image("candidates", candidates_);
  const auto sets = static_cast<std::uint32_t>(context.points.size()) / batch_size;
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(sets)));
  context.pass(name, [&](vulkan::Commands& commands) {
    for (std::uint32_t set = 0; set < sets; ++set) {
      bindings.buffer("ShaftBlock", context.constants.push(shaft_data(context, set)));
      std::uint32_t first = 0;
      do {
        if (first > 0) commands.barrier();
        const std::uint32_t end = std::min(first + nodes_per_range_, intersector.node_count());
        commands.bind(pipeline, bindings);
        commands.constants(glm::uvec4(first, end, set, 0));
        commands.dispatch((context.geometry.width / side + 7) / 8,
                          (context.geometry.height / side + 7) / 8);
        first = end;
      } while (first < intersector.node_count());
    }
  });
}

void OcclusionMask::bind(vulkan::Bindings& bindings) const {
  bindings.texture("occlusion_mask", mask_, vulkan::Sampling::nearest);
}

}  // namespace penumbra::reference
