#include "renderer/error.h"
#include "renderer/frame/caster_defects.h"
#include "renderer/frame/prepare_context.h"
#include "techniques/occluder-textures/planes.h"

namespace penumbra::techniques {
namespace {

using occluder_textures::OccluderPlane;
using occluder_textures::PlaneGroup;
using occluder_textures::PlaneSet;

/// OccluderPlaneData of shadow.glsl.
struct PlaneData {
  glm::vec4 center, normal, right, up, low, high;
};

/// OccluderGroupData, likewise.
struct GroupData {
  glm::vec4 low, high;
  glm::uvec4 members;
};

/// Groups next to each other that are passed by together.
constexpr std::uint32_t cluster_size = 8;

/// A shader walks all groups, and some drivers end its loops in silence after 65,535 rounds.
constexpr std::size_t most_groups = 20000;

PlaneData data_of(const OccluderPlane& plane) {
  const auto& rectangle = plane.rectangle;
  const glm::vec3 everywhere(std::numeric_limits<float>::max());
  PlaneData data;
  data.center = glm::vec4(rectangle.center, static_cast<float>(plane.texture));
  data.normal = glm::vec4(rectangle.normal(), plane.margin);
  data.right = glm::vec4(rectangle.right / rectangle.size.x, 0.0);
  data.up = glm::vec4(rectangle.up / rectangle.size.y, 0.0);
  const bool bounded = !plane.receivers.empty();
  data.low = glm::vec4(bounded ? glm::vec3(plane.receivers.low) : -everywhere, 0.0f);
  data.high = glm::vec4(bounded ? glm::vec3(plane.receivers.high) : everywhere, 0.0f);
  return data;
}

/// Planes with textures of the casters' silhouettes; receivers are projected onto them.
class OccluderTextures : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    const auto size = static_cast<std::uint32_t>(integer_of(input.parameters, "resolution"));
    needs.memory.push_back({"occluder textures", std::uint64_t{size} * size, size, "resolution"});
    // Which planes are worth one hangs on all casters together.
    needs.casters = CasterUse::all;
  }

  void prepare(PrepareContext& context) override {
    if (textures_) return;
    const ParameterValues& parameters = context.input.parameters;
    occluder_textures::PlaneOptions options;
    options.resolution = static_cast<std::uint32_t>(integer_of(parameters, "resolution"));
    options.most_planes = static_cast<std::uint32_t>(integer_of(parameters, "planes"));
    options.extend = static_cast<std::uint32_t>(integer_of(parameters, "extend"));
    const bool authored =
        !context.scene.scene().shadow_planes.empty() && choice_of(parameters, "source") == "scene";
    PlaneSet set = authored ? occluder_textures::authored_planes(context.scene, options)
                            : occluder_textures::generate_planes(context.scene, options);
    occluder_textures::sort_by_place(set.groups);
    sampling_ =
        boolean_of(parameters, "bilinear") ? vulkan::Sampling::linear : vulkan::Sampling::nearest;
    upload_planes(context, set);
    upload_textures(context, set, options.resolution);
    if (has_masked_casters(context.scene))
      context.notes.push_back(
          "occluder textures ignore alpha masks: masked casters cast the shadows of whole "
          "triangles");
    if (set.open > 0)
      context.notes.push_back(
          "casters with open edges and too many flat parts for a plane each, whose shadows may "
          "have "
          "gaps and spots: " +
          std::to_string(set.open));
    context.notes.push_back(std::to_string(set.planes()) +
                            (authored ? " planes of the scene" : " generated planes") +
                            " stand for " + std::to_string(set.represented) + " of " +
                            std::to_string(set.bodies) + " bodies");
  }

  void bind(vulkan::Bindings& bindings) const override {
    bindings.buffer("OccluderPlaneBlock", planes_.whole());
    bindings.buffer("OccluderGroupBlock", groups_.whole());
    bindings.buffer("OccluderClusterBlock", clusters_.whole());
    bindings.texture("occluder_textures", textures_, sampling_);
  }

 private:
  /// A block of a count and an array.
  template <class T>
  static vulkan::Buffer upload_list(PrepareContext& context, const char* name,
                                    const std::vector<T>& list) {
    const glm::uvec4 count(list.size(), 0, 0, 0);
    std::vector<std::byte> bytes(sizeof(count) + list.size() * sizeof(T));
    std::memcpy(bytes.data(), &count, sizeof(count));
    if (!list.empty())
      std::memcpy(bytes.data() + sizeof(count), list.data(), list.size() * sizeof(T));
    return upload(context.device, context.memory, name, bytes.data(), bytes.size(),
                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  }

  void upload_planes(PrepareContext& context, const PlaneSet& set) {
    if (set.groups.size() > most_groups)
      throw unsupported("occluder textures serve at most " + std::to_string(most_groups) +
                            " casters; the scene has " + std::to_string(set.groups.size()),
                        "scene");
    std::vector<PlaneData> planes;
    std::vector<GroupData> groups;
    std::vector<GroupData> clusters;
    for (const PlaneGroup& group : set.groups) {
      const Bounds box = group.box();
      // Boxes of single planes are flat, and rounding must not lose them.
      const glm::vec3 margin(1e-5 * (glm::length(box.size()) + glm::length(box.center())));
      groups.push_back({glm::vec4(glm::vec3(box.low) - margin, 0.0f),
                        glm::vec4(glm::vec3(box.high) + margin, 0.0f),
                        {planes.size(), group.planes.size(), 0, 0}});
      for (const OccluderPlane& plane : group.planes) planes.push_back(data_of(plane));
      const auto index = static_cast<std::uint32_t>(groups.size() - 1);
      if (index % cluster_size == 0)
        clusters.push_back({groups.back().low, groups.back().high, {index, 0, 0, 0}});
      clusters.back().low = glm::min(clusters.back().low, groups.back().low);
      clusters.back().high = glm::max(clusters.back().high, groups.back().high);
      ++clusters.back().members.y;
    }
    planes_ = upload_list(context, "occluder planes", planes);
    groups_ = upload_list(context, "occluder groups", groups);
    clusters_ = upload_list(context, "occluder clusters", clusters);
  }

  void upload_textures(PrepareContext& context, const PlaneSet& set, std::uint32_t resolution) {
    vulkan::ImageDescription description;
    description.format = VK_FORMAT_R8_UNORM;
    description.width = description.height = resolution;
    description.layers = std::max(1u, static_cast<std::uint32_t>(set.textures.size()));
    description.array_view = true;
    description.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    textures_ = vulkan::Image(context.device, context.memory, "occluder textures", description);
    const std::size_t layer_bytes = std::size_t{resolution} * resolution;
    vulkan::MemoryLedger passing;
    const vulkan::Buffer staging(context.device, passing, "occluder textures staging",
                                 layer_bytes * description.layers, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                 vulkan::MemoryKind::upload);
    auto* bytes = static_cast<std::uint8_t*>(staging.mapped());
    std::memset(bytes, 0, layer_bytes * description.layers);
    for (std::size_t i = 0; i < set.textures.size(); ++i)
      std::memcpy(bytes + i * layer_bytes, set.textures[i].texels().data(), layer_bytes);
    vulkan::run_now(context.device, [&](VkCommandBuffer commands) {
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, description.layers};
      copy.imageExtent = {resolution, resolution, 1};
      vkCmdCopyBufferToImage(commands, staging.handle(), textures_.handle(),
                             VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    });
  }

  vulkan::Image textures_;
  vulkan::Buffer planes_, groups_, clusters_;
  vulkan::Sampling sampling_ = vulkan::Sampling::linear;
};

Parameter integer_parameter(const char* name, std::int64_t value, double low, double high,
                            const char* unit, const char* meaning) {
  return integer(name, value, {low, high}, meaning).in(unit);
}

Parameter boolean_parameter(const char* name, const char* meaning) {
  return boolean(name, true, meaning);
}

}  // namespace

TechniqueDescription describe_occluder_textures() {
  const Parameter source = choice("source", "scene", {"scene", "generated"},
                                  "scene: the planes that the scene's author placed, and generated "
                                  "ones where there are none. generated: always those.");
  Parameter resolution = integer_parameter("resolution", 256, 16, 1024, "texels",
                                           "Width and height of every occluder texture.");
  resolution.scale = ParameterScale::logarithmic;

  TechniqueDescription description;
  description.label = "OT";
  description.title = "Occluder textures";
  description.family = "receiver";
  description.source = "Coleman 2006, 4 and 5";
  description.parameters = {
      source,
      resolution,
      integer_parameter("planes", 16, 1, 64, "",
                        "Most planes that are generated for a model; those with the largest "
                        "silhouettes are kept."),
      integer_parameter("extend", 4, 0, 32, "texels",
                        "How far silhouettes are continued into other bodies that the plane cuts, "
                        "so that shadows reach what they start at."),
      boolean_parameter("sign_test",
                        "A plane shadows only what lies behind it as the light sees it. Without "
                        "this, planes cast false shadows towards the light."),
      boolean_parameter("bilinear", "Mix the four nearest texels instead of taking the nearest.")};
  description.diagnostics = {{"textures", "The occluder textures side by side."}};
  description.create = create_technique<OccluderTextures>;
  return description;
}

}  // namespace penumbra::techniques
