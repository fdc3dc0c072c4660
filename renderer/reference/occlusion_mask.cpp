#include "renderer/reference/occlusion_mask.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "renderer/reference/light_shafts.h"

namespace penumbra::reference {
namespace {

constexpr auto batch_size = static_cast<std::uint32_t>(shader::points_per_batch);

/// Triangles that are tested in one dispatch: 8 bytes each.
constexpr std::uint32_t most_pairs = 1u << 20;

/// What all occluders of a light may take together, and all lists of them.
constexpr std::uint64_t most_list_bytes = 96u << 20;
/// An occluder, and where a list is, as occluder_lists.glsl has them.
constexpr std::uint32_t occluder_words = 2;
constexpr std::uint32_t list_words = 4;

/// A storage image of a word for each sample.
vulkan::Image make_image(PrepareContext& context, const char* name, std::uint32_t layers) {
  vulkan::ImageDescription description;
  description.format = VK_FORMAT_R32_UINT;
  description.width = context.geometry.width;
  description.height = context.geometry.height;
  description.layers = layers;
  description.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  return {context.device, context.memory, name, description};
}

/// Words that shaders write, and read as texels of so many.
vulkan::TexelBuffer make_texels(PrepareContext& context, const char* name, std::uint64_t texels,
                                VkFormat format, std::uint32_t words,
                                VkBufferUsageFlags usage = 0) {
  const std::size_t texel_bytes = words * sizeof(std::uint32_t);
  return vulkan::make_texel_buffer(context.device, context.memory, name, texels * texel_bytes,
                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | usage, format, texel_bytes);
}

vulkan::Buffer make_words(PrepareContext& context, const char* name, std::uint64_t count,
                          VkBufferUsageFlags usage = 0,
                          vulkan::MemoryKind kind = vulkan::MemoryKind::device) {
  return {context.device,
          context.memory,
          name,
          count * sizeof(std::uint32_t),
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | usage,
          kind};
}

std::vector<std::uint32_t> words_of(const vulkan::Buffer& buffer) {
  std::vector<std::uint32_t> words(buffer.size() / sizeof(std::uint32_t));
  std::memcpy(words.data(), buffer.mapped(), buffer.size());
  return words;
}

/// Places of samples in a pixel, and of these along a side.
std::uint32_t set_count(const PrepareContext& context) {
  return static_cast<std::uint32_t>(context.points.size()) / batch_size;
}
std::uint32_t side_of(std::uint32_t sets) {
  return static_cast<std::uint32_t>(std::lround(std::sqrt(sets)));
}

std::uint32_t sample_count(const PrepareContext& context) {
  return context.geometry.width * context.geometry.height;
}

std::uint32_t count_of(const std::vector<SampleList::Range>& ranges) {
  std::uint32_t count = 0;
  for (const SampleList::Range& range : ranges) count += range.count;
  return count;
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
  if (!masks_) create_masks(context);
  // Of the rounds of a picture with an error bound, the first may have one batch and later ones
  // many.
  if (many && !candidates_) create_lists(context);
  const BatchData data = push_batch(context);
  if (!many) {
    lit_.ranges.clear();
    walk(context, "occlusion mask", {"walk_hierarchy.comp", ""}, data, nullptr);
    return;
  }
  if (context.batch == 0) find_samples(context, data);
  test_listed(context, data);
  walk(context, "occlusion mask", {"walk_hierarchy.comp", "#define WITH_CANDIDATES\n"}, data,
       &walked_);
}

void OcclusionMask::create_masks(PrepareContext& context) {
  masks_ = make_texels(context, "occlusion masks", sample_count(context), VK_FORMAT_R32_UINT, 1,
                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  if (are_walks_long(context)) {
    walk_places_ = make_image(context, "walk places", 1);
    faults_ = make_words(context, "unfinished walks", 1, 0, vulkan::MemoryKind::readback);
  }
}

void OcclusionMask::create_lists(PrepareContext& context) {
  candidates_ = make_image(context, "occluder range", 2);
  lit_.texels = make_texels(context, "sample list", sample_count(context), VK_FORMAT_R32_UINT, 1);
  const std::uint64_t counts = std::uint64_t{set_count(context)} * class_count;
  class_counts_ = make_words(context, "sample classes", counts,
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  found_ = make_words(context, "sample counts", counts, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                      vulkan::MemoryKind::readback);
  list_counters_ = make_words(context, "occluder counts", 2, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              vulkan::MemoryKind::readback);
}

OcclusionMask::BatchData OcclusionMask::push_batch(PrepareContext& context) {
  BatchData data;
  for (std::uint32_t set = 0; set < set_count(context); ++set) {
    const std::vector<glm::vec4> points = points_of(context, set);
    data.shafts.push_back(context.constants.push(shaft_data(context, set)));
    data.points.push_back(context.constants.push_array(std::span(std::as_const(points))));
  }
  return data;
}

/// Sorts the samples that any of the light reaches, and lists what may hide it from them.
void OcclusionMask::find_samples(PrepareContext& context, const BatchData& data) {
  const auto clear = [&](vulkan::Commands& commands) {
    vkCmdFillBuffer(commands.handle(), class_counts_.handle(), 0, VK_WHOLE_SIZE, 0);
  };
  context.pass("find occluders", clear);
  walk(context, "find occluders", {"find_occluders.comp", ""}, data, nullptr);
  context.pass("find occluders", [&](vulkan::Commands& commands) {
    const VkBufferCopy all{0, 0, found_.size()};
    vkCmdCopyBuffer(commands.handle(), class_counts_.handle(), found_.handle(), 1, &all);
    commands.barrier();
    clear(commands);
  });
  // The counts say how much the passes to come have to do.
  context.recorder.flush();
  const SampleClasses classes(words_of(found_), sample_count(context) / set_count(context));
  sort_samples(context, classes);
  lit_.ranges = classes.ranges(0, 1);
  for (SampleList::Range& range : lit_.ranges) range.fully_lit = true;
  for (const SampleList::Range& range : classes.ranges(1, class_count))
    lit_.ranges.push_back(range);
  list_occluders(context, data, classes);
}

void OcclusionMask::sort_samples(PrepareContext& context, const SampleClasses& classes) {
  const vulkan::Pipeline& pipeline =
      context.pipelines.compute("renderer/reference/sort_samples.comp", "");
  vulkan::Bindings bindings = context.frame_bindings;
  bindings.buffer("MaskBlock", masks_.buffer.whole());
  bindings.buffer("ListedBlock", lit_.texels.buffer.whole());
  bindings.buffer("ClassBlock", class_counts_.whole());
  const std::uint32_t sets = set_count(context);
  context.pass("find occluders", [&](vulkan::Commands& commands) {
    for (std::uint32_t set = 0; set < sets; ++set) {
      std::vector<glm::uvec4> starts;
      for (std::uint32_t kind = 0; kind < class_count; ++kind)
        starts.emplace_back(classes.ranges(kind, kind + 1)[set].first);
      bindings.buffer("StartBlock", context.constants.push_array(std::span(std::as_const(starts))));
      commands.bind(pipeline, bindings);
      SampleWork work;
      work.set = set;
      dispatch_all(commands, context.geometry.width, context.geometry.height, side_of(sets), work);
    }
  });
}

/// Writes down what may hide the light from samples in penumbrae, where that is little.
void OcclusionMask::list_occluders(PrepareContext& context, const BatchData& data,
                                   const SampleClasses& classes) {
  // Lists as long as the memory allows: a class is the number of triangles.
  std::uint32_t longest = shader::most_occluders;
  const auto bytes = [](std::uint64_t count, std::uint32_t words) {
    return count * words * sizeof(std::uint32_t);
  };
  while (bytes(classes.places(longest), occluder_words) > most_list_bytes ||
         bytes(count_of(classes.ranges(1, longest + 1)), list_words) > most_list_bytes)
    --longest;
  chunks_ = classes.chunks(longest, most_pairs);
  listed_ = classes.ranges(1, longest + 1);
  walked_ = classes.ranges(longest + 1, class_count);
  if (chunks_.empty()) return;
  const auto reserve = [&](vulkan::TexelBuffer& buffer, const char* name, std::uint64_t texels,
                           VkFormat format, std::uint32_t words, VkBufferUsageFlags usage = 0) {
    if (buffer.buffer.size() >= texels * words * sizeof(std::uint32_t)) return;
    buffer = {};
    buffer = make_texels(context, name, texels, format, words, usage);
  };
  reserve(occluders_, "occluder lists", classes.places(longest), VK_FORMAT_R32G32_UINT,
          occluder_words);
  reserve(lists_, "occluder list places", count_of(listed_), VK_FORMAT_R32G32B32A32_UINT,
          list_words);
  reserve(pairs_, "occluder pairs", 2 + std::uint64_t{most_pairs}, VK_FORMAT_R32G32_UINT, 2,
          VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  BatchData boxes = data;
  for (std::uint32_t set = 0; set < set_count(context); ++set)
    boxes.boxes.push_back(context.constants.push(batch_boxes(context, set)));
  std::memset(list_counters_.mapped(), 0, list_counters_.size());
  walk(context, "list occluders", {"list_occluders.comp", ""}, boxes, &listed_);
  context.recorder.flush();
  if (words_of(list_counters_)[1] == 0) return;
  // Rounding has found triangles here that it did not find before: the hierarchy is walked instead.
  chunks_.clear();
  walked_ = classes.ranges(1, class_count);
}

/// Writes the masks of samples with lists.
void OcclusionMask::test_listed(PrepareContext& context, const BatchData& data) {
  if (chunks_.empty()) return;
  const std::string holes =
      Intersector::of(context.device, context.scene).has_holes() ? "#define WITH_HOLES\n" : "";
  const vulkan::Pipeline& select = context.pipelines.compute("renderer/reference/select_pairs.comp",
                                                             holes + "#define WITH_SAMPLE_LIST\n");
  const vulkan::Pipeline& test =
      context.pipelines.compute("renderer/reference/test_pairs.comp", holes);
  vulkan::Bindings bindings = own_bindings(context);
  SampleWork work;
  context.pass("occlusion mask", [&](vulkan::Commands& commands) {
    for (const SampleClasses::Chunk& chunk : chunks_) {
      const std::uint32_t none[4] = {0, 1, 1, 0};  // of groups, and of pairs
      vkCmdUpdateBuffer(commands.handle(), pairs_.buffer.handle(), 0, sizeof(none), none);
      commands.barrier();
      bindings.buffer("ShaftBlock", data.shafts[chunk.range.set]);
      bindings.buffer("LightPointBlock", data.points[chunk.range.set]);
      work.slot = chunk.slot;
      commands.bind(select, bindings);
      dispatch_range(commands, chunk.range, work);
      commands.barrier();
      commands.bind(test, bindings);
      commands.dispatch_indirect(pairs_.buffer);
      commands.barrier();
    }
  });
}

vulkan::Bindings OcclusionMask::own_bindings(const PrepareContext& context) const {
  vulkan::Bindings bindings = context.frame_bindings;
  Intersector::of(context.device, context.scene).bind(bindings);
  bindings.buffer("MaskBlock", masks_.buffer.whole());
  if (candidates_) bindings.storage_image("candidates", candidates_);
  if (walk_places_) bindings.storage_image("walk_places", walk_places_);
  if (faults_) bindings.buffer("FaultBlock", faults_.whole());
  if (class_counts_) bindings.buffer("ClassBlock", class_counts_.whole());
  if (list_counters_) bindings.buffer("CounterBlock", list_counters_.whole());
  if (lit_.texels) bindings.texel_buffer("listed_samples", lit_.texels.view);
  const auto both = [&](const char* block, const char* texels, const vulkan::TexelBuffer& bound) {
    if (!bound) return;
    bindings.buffer(block, bound.buffer.whole());
    bindings.texel_buffer(texels, bound.view);
  };
  both("ListBlock", "list_texels", lists_);
  both("OccluderBlock", "occluder_texels", occluders_);
  both("PairBlock", "pair_texels", pairs_);
  return bindings;
}

void OcclusionMask::walk(PrepareContext& context, const std::string& name, Program program,
                         const BatchData& data, const Ranges* ranges) {
  const Intersector& intersector = Intersector::of(context.device, context.scene);
  SampleWork work;
  work.nodes = intersector.node_count();
  work.rounds = rounds_;
  if (ranges != nullptr) {
    if (count_of(*ranges) == 0) return;
    program.defines += "#define WITH_SAMPLE_LIST\n";
  }
  const bool are_long = are_walks_long(context);
  if (intersector.has_holes()) program.defines += "#define WITH_HOLES\n";
  if (are_long) program.defines += "#define LONG_WALKS\n";
  vulkan::Bindings bindings = own_bindings(context);
  const std::uint32_t sets = set_count(context);
  const char* resumed = "";
  do {
    const vulkan::Pipeline& pipeline = context.pipelines.compute(
        std::string("renderer/reference/") + program.file, program.defines + resumed);
    if (are_long) std::memset(faults_.mapped(), 0, faults_.size());
    context.pass(name, [&](vulkan::Commands& commands) {
      work.slot = 0;
      for (std::uint32_t set = 0; set < sets; ++set) {
        bindings.buffer("ShaftBlock", data.shafts[set]);
        bindings.buffer("LightPointBlock", data.points[set]);
        if (!data.boxes.empty()) bindings.buffer("BatchBoxBlock", data.boxes[set]);
        commands.bind(pipeline, bindings);
        work.set = set;
        if (ranges == nullptr) {
          dispatch_all(commands, context.geometry.width, context.geometry.height, side_of(sets),
                       work);
        } else {
          dispatch_range(commands, (*ranges)[set], work);
          work.slot += (*ranges)[set].count;
        }
      }
    });
    resumed = "#define RESUMED\n";
  } while (are_long && unfinished(context) > 0);
}

/// Whether a walk may take so many rounds that a driver ends it; otherwise the frame's own counter
/// sees that none is.
bool OcclusionMask::are_walks_long(const PrepareContext& context) const {
  const Intersector& intersector = Intersector::of(context.device, context.scene);
  // Half of the nodes are leaves, and a test of one with holes goes through all points in a loop.
  const std::uint64_t rounds_of_node = intersector.has_holes() ? 1 + (batch_size + 1) / 2 + 1 : 1;
  return rounds_of_node * intersector.node_count() > rounds_;
}

/// Walks that the last pass left off.
std::uint32_t OcclusionMask::unfinished(PrepareContext& context) const {
  context.recorder.flush();
  return words_of(faults_)[0];
}

void OcclusionMask::bind(vulkan::Bindings& bindings) const {
  bindings.texel_buffer("occlusion_masks", masks_.view);
}

}  // namespace penumbra::reference
