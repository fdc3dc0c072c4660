#include "renderer/reference/light_shafts.h"

#include <algorithm>

#include "renderer/reference/occlusion_mask.h"
#include "renderer/scene/scene.h"

namespace penumbra::reference {

using shader::points_per_batch;

namespace {

/// Box around the whole extent: positions, or directions of any length.
Bounds extent_box(const WorldLight& light) {
  const glm::dvec3 half = extent_half_size(*light.source);
  const glm::dvec3 reach = glm::abs(light.right) * half.x + glm::abs(light.up) * half.y +
                           glm::abs(light.direction) * half.z;
  const glm::dvec3 middle(light.center);
  return {middle - reach, middle + reach};
}

/// Of the hierarchy's units, in a metre; directions are as long as they are.
double unit_of_points(const PrepareContext& context) {
  return glm::mix(1.0, double{context.scene.inverse_size()}, context.light.center.w);
}

/// Widens a box by what rounding of points and receivers may do: that grows with their coordinates,
/// or is that of unit directions at infinity, where `w` of the light's centre is 0.
void widen(Bounds& box, double w, const GpuScene& scene) {
  const glm::dvec3 reached(glm::max(glm::abs(scene.low()), glm::abs(scene.high())));
  const glm::dvec3 far = glm::max(glm::max(glm::abs(box.low), glm::abs(box.high)),
                                  double{scene.inverse_size()} * reached);
  const double reach = glm::mix(1.0, std::max({far.x, far.y, far.z}), w);
  box.low -= 1e-6 * reach;
  box.high += 1e-6 * reach;
}

/// Rasterisers interpolate positions from a corner of the picture: how far they round grows with
/// what lies between its borders. Of a picture that is longer than this ratio it shows (lavapipe,
/// 1218 by 8 pixels).
constexpr float usual_ratio = 16.0f;

/// Of a batch; where there are more batches than bits, neighbours share one.
std::uint32_t bit_of(const PrepareContext& context, std::uint32_t batch) {
  const std::uint32_t bits = std::min<std::uint32_t>(shader::batch_bits, context.batches);
  return static_cast<std::uint32_t>(std::uint64_t{batch} * bits / context.batches);
}

/// How far receivers may lie from their surface, as a share of their places.
float rounding_in(const GeometryBuffer& picture) {
  const auto [low, high] = std::minmax(picture.width, picture.height);
  const float ratio = static_cast<float>(high) / static_cast<float>(low);
  return receiver_rounding * std::max(1.0f, ratio / usual_ratio);
}

}  // namespace

std::vector<glm::vec4> points_of(const PrepareContext& context, std::uint32_t set) {
  const auto points = context.points.subspan(std::size_t{set} * points_per_batch, points_per_batch);
  const double scale = unit_of_points(context);
  std::vector<glm::vec4> scaled;
  for (const glm::vec4& point : points) scaled.emplace_back(scale * glm::dvec3(point), point.w);
  return scaled;
}

shader::ShaftData shaft_data(const PrepareContext& context, std::uint32_t set) {
  shader::ShaftData data{};
  const std::vector<glm::vec4> points = points_of(context, set);
  Bounds batch;
  for (std::uint32_t i = 0; i < context.points_in_batch; ++i) batch.add(glm::dvec3(points[i]));
  Bounds whole = extent_box(context.light);
  whole.low *= unit_of_points(context);
  whole.high *= unit_of_points(context);
  widen(batch, context.light.center.w, context.scene);
  widen(whole, context.light.center.w, context.scene);
  data.box_low = glm::vec4(batch.low, context.light.center.w);
  data.box_high = glm::vec4(batch.high, rounding_in(context.geometry));
  data.whole_low = glm::vec4(whole.low, extent_radius(*context.light.source));
  data.whole_high = glm::vec4(whole.high, context.scene.inverse_size());
  data.bits.x = context.points_in_batch < points_per_batch ? ~0u << context.points_in_batch : 0u;
  data.bits.y = bit_of(context, context.batch);
  return data;
}

std::array<shader::BatchBox, shader::batch_bits> batch_boxes(const PrepareContext& context,
                                                             std::uint32_t set) {
  const std::size_t sets = context.points.size() / points_per_batch;
  const std::size_t in_set = context.all_points.size() / sets;
  const auto points = context.all_points.subspan(set * in_set, in_set);
  std::array<Bounds, shader::batch_bits> boxes;
  for (std::uint32_t i = 0; i < in_set; ++i)
    boxes[bit_of(context, i / points_per_batch)].add(unit_of_points(context) *
                                                     glm::dvec3(points[i]));
  std::array<shader::BatchBox, shader::batch_bits> data;
  for (std::size_t bit = 0; bit < boxes.size(); ++bit) {
    // Bits that no batch has are asked for as well.
    Bounds box = bit <= bit_of(context, context.batches - 1) ? boxes[bit] : boxes[0];
    widen(box, context.light.center.w, context.scene);
    data[bit].middle = glm::vec4(0.5 * box.low + 0.5 * box.high, 0.0);
    data[bit].half_size = glm::vec4(0.5 * box.high - 0.5 * box.low, 0.0);
  }
  return data;
}

}  // namespace penumbra::reference
