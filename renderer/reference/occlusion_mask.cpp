#include "renderer/reference/occlusion_mask.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace penumbra::reference {
namespace {

constexpr auto batch_size = static_cast<std::uint32_t>(shader::points_per_batch);

/// Lists of occluders: places of a sample, and what all lists of a light may take together.
constexpr std::uint64_t most_occluders = 64;
constexpr std::uint64_t least_occluders = 8;
constexpr std::uint64_t occluder_bytes = 96u << 20;

/// Behind the two counts of each set: samples with more occluders than places.
constexpr std::uint32_t overflow_place = 2 * shader::max_supersampling;

struct ExtentBox {
  glm::dvec3 low, high;
};

/// Box around the whole extent: positions, or directions of any length.
ExtentBox extent_box(const WorldLight& light) {
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
void widen(ExtentBox& box, double w, const GpuScene& scene) {
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

/// How far receivers may lie from their surface, as a share of their places.
float rounding_in(const GeometryBuffer& picture) {
  const auto [low, high] = std::minmax(picture.width, picture.height);
  const float ratio = static_cast<float>(high) / static_cast<float>(low);
  return receiver_rounding * std::max(1.0f, ratio / usual_ratio);
}

/// Places of the light's points in the hierarchy's units, or directions as they are.
std::vector<glm::vec4> points_of(const PrepareContext& context, std::uint32_t set) {
  const auto points = context.points.subspan(std::size_t{set} * batch_size, batch_size);
  const double scale = unit_of_points(context);
  std::vector<glm::vec4> scaled;
  for (const glm::vec4& point : points) scaled.emplace_back(scale * glm::dvec3(point), point.w);
  return scaled;
}

/// For the points of one sample of a pixel.
shader::ShaftData shaft_data(const PrepareContext& context, std::uint32_t set) {
  shader::ShaftData data{};
  const std::vector<glm::vec4> points = points_of(context, set);
  ExtentBox batch{glm::dvec3(points.front()), glm::dvec3(points.front())};
  for (std::uint32_t i = 0; i < context.points_in_batch; ++i) {
    batch.low = glm::min(batch.low, glm::dvec3(points[i]));
    batch.high = glm::max(batch.high, glm::dvec3(points[i]));
  }
  ExtentBox whole = extent_box(context.light);
  whole.low *= unit_of_points(context);
  whole.high *= unit_of_points(context);
  widen(batch, context.light.center.w, context.scene);
  widen(whole, context.light.center.w, context.scene);
  data.box_low = glm::vec4(batch.low, context.light.center.w);
  data.box_high = glm::vec4(batch.high, rounding_in(context.geometry));
  data.whole_low = glm::vec4(whole.low, extent_radius(*context.light.source));
  data.whole_high = glm::vec4(whole.high, context.scene.inverse_size());
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

std::uint32_t set_count(const PrepareContext& context) {
  return static_cast<std::uint32_t>(context.points.size()) / batch_size;
}

}  // namespace

float rounding_of(const GpuScene& scene, const glm::vec3& position,
                  const glm::vec3& camera_position) {
  const float within =
      std::min(glm::length(position - camera_position), 2.0f / scene.inverse_size());
  return receiver_rounding * (glm::length(position) + within);
}

void OcclusionMask::trace(PrepareContext& context) {
  // One batch is not worth a look at the whole light first.
  const bool many = context.batches > 1;
  if (!mask_) create(context, many);
  if (!many) {
    while (!dispatch_sets(context, "occlusion mask", "", nullptr)) {
    }
    return;
  }
  if (context.batch == 0) {
    find_samples(context);
    list_occluders(context);
  }
  if (occluder_limit_ > 0)
    while (!dispatch_sets(context, "occlusion mask", "#define OCCLUDERS_LISTED\n", &partly_lit_)) {
    }
  if (occluder_limit_ > 0 && overflowed_ == 0) return;
  const char* unlisted = occluder_limit_ > 0
                             ? "#define WITH_CANDIDATES\n#define SOME_OCCLUDERS_LISTED\n"
                             : "#define WITH_CANDIDATES\n";
  while (!dispatch_sets(context, "occlusion mask", unlisted, &partly_lit_)) {
  }
}

void OcclusionMask::create(PrepareContext& context, bool many) {
  mask_ = make_image(context, "occlusion mask", 1);
  if (!many) return;
  candidates_ = make_image(context, "occluder range", 2);
  const VkDeviceSize samples = VkDeviceSize{context.geometry.width} * context.geometry.height;
  lit_.texels = {context.device, context.memory, "sample list", samples * sizeof(std::uint32_t),
                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
  found_ = {context.device,
            context.memory,
            "sample counts",
            (overflow_place + 1) * sizeof(std::uint32_t),
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            vulkan::MemoryKind::readback};
}

/// Lists the samples that part and all of the light reaches.
void OcclusionMask::find_samples(PrepareContext& context) {
  do std::memset(found_.mapped(), 0, found_.size());
  while (!dispatch_sets(context, "find occluders", "#define FIND_CANDIDATES\n", nullptr));
  // The counts say how much the passes to come have to do.
  context.recorder.flush();
  const std::uint32_t capacity =
      context.geometry.width * context.geometry.height / set_count(context);
  partly_lit_.clear();
  lit_.ranges.clear();
  for (std::uint32_t set = 0; set < set_count(context); ++set) {
    const std::uint32_t fully = found(2 * set + 1);
    partly_lit_.push_back({set, set * capacity, found(2 * set)});
    lit_.ranges.push_back(partly_lit_.back());
    lit_.ranges.push_back({set, (set + 1) * capacity - fully, fully, true});
  }
}

/// Writes down what may hide the light from each sample that part of it reaches.
void OcclusionMask::list_occluders(PrepareContext& context) {
  std::uint64_t samples = 0;
  for (const SampleList::Range& range : partly_lit_) samples += range.count;
  occluder_limit_ = 0;
  overflowed_ = 0;
  // A walk in parts would have to go on where a list ends: not worth it.
  if (samples == 0 ||
      Intersector::of(context.device, context.scene).node_count() > nodes_per_range_)
    return;
  const std::uint64_t places = occluder_bytes / sizeof(std::uint32_t) / samples;
  occluder_limit_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(most_occluders, places));
  if (occluder_limit_ <= least_occluders) {
    occluder_limit_ = 0;
    return;
  }
  --occluder_limit_;  // a place for the count
  const VkDeviceSize bytes = samples * (occluder_limit_ + 1) * sizeof(std::uint32_t);
  if (occluders_.size() < bytes) {
    occluders_ = {};
    occluders_ = {context.device, context.memory, "occluder lists", bytes,
                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
  }
  if (!dispatch_sets(context, "list occluders", "#define LIST_OCCLUDERS\n#define WITH_CANDIDATES\n",
                     &partly_lit_)) {
    occluder_limit_ = 0;
    return;
  }
  context.recorder.flush();
  overflowed_ = found(overflow_place);
}

std::uint32_t OcclusionMask::found(std::uint32_t place) const {
  std::uint32_t value = 0;
  std::memcpy(&value, static_cast<const char*>(found_.mapped()) + place * sizeof(value),
              sizeof(value));
  return value;
}

/// Runs a variant of the program at the ranges of a list, one for each set, or at all samples.
bool OcclusionMask::dispatch_sets(PrepareContext& context, const std::string& name,
                                  std::string defines,
                                  const std::vector<SampleList::Range>* ranges) {
  const Intersector& intersector = Intersector::of(context.device, context.scene);
  if (intersector.has_holes()) defines += "#define WITH_HOLES\n";
  if (ranges != nullptr) defines += "#define WITH_SAMPLE_LIST\n";
  const vulkan::Pipeline& pipeline =
      context.pipelines.compute("renderer/reference/occlusion_mask.comp", defines);
  vulkan::Bindings bindings = context.frame_bindings;
  intersector.bind(bindings);
  bindings.storage_image("occlusion_mask", mask_);
  if (candidates_) bindings.storage_image("candidates", candidates_);
  if (lit_.texels) bindings.buffer("SampleBlock", lit_.texels.whole());
  if (found_) bindings.buffer("FoundBlock", found_.whole());
  if (occluders_) bindings.buffer("OccluderBlock", occluders_.whole());
  if (may_end_early(context)) {
    if (!faults_)
      faults_ = {context.device,
                 context.memory,
                 "walk faults",
                 2 * sizeof(std::uint32_t),
                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                 vulkan::MemoryKind::readback};
    std::memset(faults_.mapped(), 0, faults_.size());
    bindings.buffer("FaultBlock", faults_.whole());
  }
  SampleWork work;
  work.occluder_limit = occluder_limit_;
  work.overflow_place = overflow_place;
  for (const SampleList::Range& range : partly_lit_) work.stride += range.count;
  context.pass(name, [&](vulkan::Commands& commands) {
    for (std::uint32_t set = 0; set < set_count(context); ++set) {
      bindings.buffer("ShaftBlock", context.constants.push(shaft_data(context, set)));
      bindings.buffer("LightPointBlock", context.constants.push_array(
                                             std::span<const glm::vec4>(points_of(context, set))));
      commands.bind(pipeline, bindings);
      work.set = set;
      walk(context, commands, ranges == nullptr ? nullptr : &(*ranges)[set], work);
      if (ranges != nullptr) work.slot += (*ranges)[set].count;
    }
  });
  return finished(context);
}

/// Whether a walk may take so many rounds that a driver ends it; otherwise the frame's own counter
/// sees that none is.
bool OcclusionMask::may_end_early(const PrepareContext& context) const {
  constexpr std::uint32_t surely_finished = 8000;
  return std::min(nodes_per_range_, Intersector::of(context.device, context.scene).node_count()) >
         surely_finished;
}

bool OcclusionMask::finished(PrepareContext& context) {
  if (!may_end_early(context)) return true;
  context.recorder.flush();
  std::uint32_t counts[2];
  std::memcpy(counts, faults_.mapped(), sizeof(counts));
  if (counts[1] == 0) return true;
  nodes_per_range_ =
      std::min(nodes_per_range_, Intersector::of(context.device, context.scene).node_count()) / 2;
  return false;
}

/// Dispatches the bound program, several times where the hierarchy is too large for one walk.
void OcclusionMask::walk(const PrepareContext& context, vulkan::Commands& commands,
                         const SampleList::Range* range, SampleWork work) const {
  const std::uint32_t nodes = Intersector::of(context.device, context.scene).node_count();
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(set_count(context))));
  do {
    if (work.first_node > 0) commands.barrier();
    work.end_node = std::min(work.first_node + nodes_per_range_, nodes);
    work.last = work.end_node == nodes ? 1 : 0;
    if (range != nullptr)
      dispatch_range(commands, *range, work);
    else
      dispatch_all(commands, context.geometry.width, context.geometry.height, side, work);
    work.first_node = work.end_node;
  } while (work.first_node < nodes);
}

void OcclusionMask::bind(vulkan::Bindings& bindings) const {
  bindings.texture("occlusion_mask", mask_, vulkan::Sampling::nearest);
}

}  // namespace penumbra::reference
