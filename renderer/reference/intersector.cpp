#include "renderer/reference/intersector.h"

#include <algorithm>
#include <cstring>

#include "renderer/scene/coverage.h"
#include "renderer/vulkan/texel_view.h"

namespace penumbra::reference {
namespace {

constexpr std::uint32_t no_hole = 0xffffffffu;

struct TriangleTexels {
  struct Corner {
    glm::vec3 position;
    std::uint32_t hole;  ///< of the first corner: index into the triangles with holes, or no_hole
  } corners[3];
};
static_assert(sizeof(TriangleTexels) == 48);

/// What decides whether a point of a masked triangle is a hole. Read as three texels.
struct HoleTexels {
  glm::vec2 uvs[3];
  float alphas[3];  ///< at the corners, of material and vertices
  float cutoff;
  std::uint32_t first_alpha;  ///< of the texture
  std::uint32_t size;         ///< width, and height in the upper half
};
static_assert(sizeof(HoleTexels) == 48);

/// Collects what the device reads of a scene's casters.
class Gatherer {
 public:
  explicit Gatherer(const GpuScene& scene) : scene_(scene) {
    for (const DrawRange& range : scene.ranges())
      if (range.casts_shadow) add(range);
  }

  std::vector<Triangle> triangles;
  std::vector<TriangleTexels> texels;
  std::vector<HoleTexels> holes;
  std::vector<std::uint8_t> alphas;

 private:
  void add(const DrawRange& range) {
    for (std::uint32_t i = 0; i + 2 < range.index_count; i += 3) {
      const std::uint32_t* corners = &scene_.indices()[range.first_index + i];
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k)
        triangle[k] = scene_.inverse_size() * scene_.positions()[corners[k]];
      TriangleTexels out{};
      for (std::size_t k = 0; k < 3; ++k) out.corners[k] = {triangle[k], no_hole};
      if (range.masked) {
        out.corners[0].hole = static_cast<std::uint32_t>(holes.size());
        holes.push_back(hole(range, corners));
      }
      triangles.push_back(triangle);
      texels.push_back(out);
    }
  }

  HoleTexels hole(const DrawRange& range, const std::uint32_t* corners) {
    const Scene& scene = scene_.scene();
    const Mesh& mesh = scene.meshes[scene.instances[range.instance].mesh];
    const Material& material = scene.materials[range.material];
    HoleTexels out{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = corners[k] - scene_.first_vertex(range.instance);
      out.uvs[k] = mesh.uvs.empty() ? glm::vec2(0.0f) : mesh.uvs[vertex];
      out.alphas[k] = material.alpha * (mesh.colors.empty() ? 1.0f : mesh.colors[vertex].a);
    }
    out.cutoff = interpolated_cutoff(material);
    out.first_alpha = alphas_of(material.texture);
    out.size = material.texture < 0
                   ? 1u << 16 | 1u
                   : scene.textures[static_cast<std::size_t>(material.texture)].width |
                         scene.textures[static_cast<std::size_t>(material.texture)].height << 16;
    return out;
  }

  /// Where the alphas of a texture begin; -1 is white.
  std::uint32_t alphas_of(int texture) {
    const auto known = first_alpha_.find(texture);
    if (known != first_alpha_.end()) return known->second;
    const auto first = static_cast<std::uint32_t>(alphas.size());
    first_alpha_[texture] = first;
    if (texture < 0) {
      alphas.push_back(255);
    } else {
      const auto& rgba = scene_.scene().textures[static_cast<std::size_t>(texture)].rgba;
      for (std::size_t i = 3; i < rgba.size(); i += 4) alphas.push_back(rgba[i]);
    }
    return first;
  }

  const GpuScene& scene_;
  std::map<int, std::uint32_t> first_alpha_;
};

/// Boxes grow by what float arithmetic may lose between them and a receiver in the scene.
void widen(std::vector<Node>& nodes, const GpuScene& scene) {
  const glm::vec3 reach =
      scene.inverse_size() * glm::max(glm::abs(scene.low()), glm::abs(scene.high()));
  for (Node& node : nodes) {
    const glm::vec3 own = glm::max(reach, glm::max(glm::abs(node.low), glm::abs(node.high)));
    const float margin = 1e-6f * std::max({own.x, own.y, own.z});
    node.low -= margin;
    node.high += margin;
  }
}

}  // namespace

Intersector::Intersector(vulkan::Device& device, const GpuScene& scene) {
  const Gatherer casters(scene);
  std::vector<Node> nodes = build_hierarchy(casters.triangles);
  widen(nodes, scene);
  node_count_ = static_cast<std::uint32_t>(nodes.size());
  has_holes_ = !casters.holes.empty();
  const auto texels = [&](const char* name, const auto& list, VkFormat format,
                          std::size_t texel_bytes) {
    return make(device, name, list.data(), list.size() * sizeof(list[0]), format, texel_bytes);
  };
  nodes_ = texels("hierarchy nodes", nodes, VK_FORMAT_R32G32B32A32_UINT, 16);
  triangles_ = texels("hierarchy triangles", casters.texels, VK_FORMAT_R32G32B32A32_UINT, 16);
  if (!has_holes_) return;
  hole_triangles_ = texels("hole triangles", casters.holes, VK_FORMAT_R32G32B32A32_UINT, 16);
  hole_alphas_ = texels("hole alphas", casters.alphas, VK_FORMAT_R8_UNORM, 1);
}

const Intersector& Intersector::of(vulkan::Device& device, const GpuScene& scene) {
  return scene.derived<Intersector>(
      [&] { return std::make_shared<const Intersector>(device, scene); });
}

vulkan::TexelBuffer Intersector::make(vulkan::Device& device, const std::string& name,
                                      const void* data, std::size_t bytes, VkFormat format,
                                      std::size_t texel_bytes) {
  vulkan::TexelBuffer made;
  made.buffer =
      upload(device, ledger_, name, data, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  made.view = vulkan::texel_view(device, name, made.buffer, format, texel_bytes);
  return made;
}

void Intersector::bind(vulkan::Bindings& bindings) const {
  bindings.texel_buffer("hierarchy_nodes", nodes_.view);
  bindings.texel_buffer("hierarchy_triangles", triangles_.view);
  if (!has_holes_) return;
  bindings.texel_buffer("hole_triangles", hole_triangles_.view);
  bindings.texel_buffer("hole_alphas", hole_alphas_.view);
}

}  // namespace penumbra::reference
