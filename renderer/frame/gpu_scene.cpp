#include "renderer/frame/gpu_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numeric>

#include "renderer/error.h"
#include "renderer/frame/split_triangles.h"
#include "renderer/frame/triangle_order.h"
#include "renderer/shaders/shader_types.h"

namespace penumbra {
namespace {

struct SurfaceVertex {
  glm::vec3 normal;
  glm::vec2 uv;
  std::uint32_t color;
  glm::vec3 facet;  ///< unit normal, as wound, of the triangle that has its first corner here
};
static_assert(sizeof(SurfaceVertex) == 36, "as pipeline.cpp declares the vertex layout");

constexpr std::uint32_t white = 0xffffffffu;

/// Of positions rounded to floats, relative: a few units in their last place.
constexpr double position_rounding = 2.4e-7;

/// Unit normal of a triangle by its winding. Corners that lie on floats lose what the normal of a
/// flat facet, given with all of them, still has.
glm::vec3 facet_normal(const std::array<glm::vec3, 3>& corners,
                       const std::array<const SurfaceVertex*, 3>& given) {
  const glm::dvec3 a(corners[0]);
  const glm::dvec3 along = glm::dvec3(corners[1]) - a, aside = glm::dvec3(corners[2]) - a;
  const glm::dvec3 across = glm::cross(along, aside);
  const double area = glm::length(across);
  const glm::vec3 first = given[0]->normal;
  if (!(area > 0.0) || !std::isfinite(area)) return first;
  const glm::dvec3 facet = across / area;
  if (given[1]->normal != first || given[2]->normal != first) return glm::vec3(facet);
  const double doubt =
      position_rounding * glm::length(a) * std::max(glm::length(along), glm::length(aside)) / area;
  return glm::length(glm::dvec3(first) - facet) < doubt ? first : glm::vec3(facet);
}

}  // namespace

vulkan::Buffer upload(vulkan::Device& device, vulkan::MemoryLedger& ledger, const std::string& name,
                      const void* data, std::size_t bytes, VkBufferUsageFlags usage) {
  const std::size_t size =
      std::max<std::size_t>(bytes, 16);  // an empty scene still binds something
  vulkan::Buffer buffer(device, ledger, name, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  if (bytes == 0) return buffer;
  vulkan::MemoryLedger passing;
  const vulkan::Buffer staging(device, passing, name + " staging", bytes,
                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vulkan::MemoryKind::upload);
  std::memcpy(staging.mapped(), data, bytes);
  vulkan::run_now(device, [&](VkCommandBuffer commands) {
    const VkBufferCopy copy{0, 0, bytes};
    vkCmdCopyBuffer(commands, staging.handle(), buffer.handle(), 1, &copy);
  });
  return buffer;
}

vulkan::Image upload_texture(vulkan::Device& device, vulkan::MemoryLedger& ledger,
                             const Texture& texture) {
  vulkan::ImageDescription description;
  description.format = VK_FORMAT_R8G8B8A8_SRGB;
  description.width = texture.width;
  description.height = texture.height;
  description.levels =
      static_cast<std::uint32_t>(std::bit_width(std::max(texture.width, texture.height)));
  description.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                      VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  vulkan::Image image(device, ledger, "texture " + texture.name, description);
  vulkan::MemoryLedger passing;
  const vulkan::Buffer staging(device, passing, "texture staging", texture.rgba.size(),
                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vulkan::MemoryKind::upload);
  std::memcpy(staging.mapped(), texture.rgba.data(), texture.rgba.size());
  vulkan::run_now(device, [&](VkCommandBuffer commands) {
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {texture.width, texture.height, 1};
    vkCmdCopyBufferToImage(commands, staging.handle(), image.handle(), VK_IMAGE_LAYOUT_GENERAL, 1,
                           &copy);
    auto extent = [&](std::uint32_t level) {
      return VkOffset3D{static_cast<std::int32_t>(std::max(1u, texture.width >> level)),
                        static_cast<std::int32_t>(std::max(1u, texture.height >> level)), 1};
    };
    for (std::uint32_t level = 1; level < description.levels; ++level) {
      vulkan::global_barrier(commands);
      VkImageBlit blit{};
      blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level - 1, 0, 1};
      blit.srcOffsets[1] = extent(level - 1);
      blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
      blit.dstOffsets[1] = extent(level);
      vkCmdBlitImage(commands, image.handle(), VK_IMAGE_LAYOUT_GENERAL, image.handle(),
                     VK_IMAGE_LAYOUT_GENERAL, 1, &blit, VK_FILTER_LINEAR);
    }
  });
  return image;
}

GpuScene::GpuScene(vulkan::Device& device, std::shared_ptr<const Scene> scene,
                   std::vector<InstanceUse> uses, std::vector<bool> textures,
                   const SceneFrame& frame)
    : scene_(std::move(scene)),
      uses_(std::move(uses)),
      needed_textures_(std::move(textures)),
      frame_(frame),
      coverages_(*scene_) {
  // Of the whole scene: what the plan leaves out must not move a single bit of the rest.
  const Bounds bounds = world_bounds(*scene_);
  if (const Bounds part = near_part(bounds); !part.empty()) {
    low_ = glm::vec3(part.low);
    high_ = glm::vec3(part.high);
  }
  find_coarse_coordinates();
  flatten();
  // Texel buffers, not storage buffers, whose size is limited: a scene may be larger.
  constexpr VkBufferUsageFlags vertex =
      VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
  constexpr VkBufferUsageFlags index = VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
  std::vector<glm::vec3> positions = position_list_;
  const std::vector<std::uint32_t> surface_indices = add_facets(positions);
  meet_at_places();
  positions_ =
      upload(device, ledger_, "positions", positions.data(), positions.size() * 12, vertex);
  surfaces_ = upload(device, ledger_, "surface attributes", surface_list_.data(),
                     surface_list_.size(), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  indices_ = upload(device, ledger_, "indices", index_list_.data(), index_list_.size() * 4, index);
  surface_indices_ = upload(device, ledger_, "surface indices", surface_indices.data(),
                            surface_indices.size() * 4, index);
  surface_list_ = {};
  orders_.clear();
  first_at_ = {};
  upload_materials(device);
}

std::vector<GpuScene::Part> GpuScene::find_parts() {
  // Of the whole scene: an order that followed what the camera sees would let surfaces that
  // coincide take turns.
  std::map<std::uint32_t, double> largest;  // thing that has a material, m
  for (const Instance& instance : scene_->instances) {
    const double size = glm::length(instance_bounds(*scene_, instance).size());
    for (const Primitive& primitive : scene_->meshes[instance.mesh].primitives) {
      double& so_far = largest[primitive.material];
      so_far = std::max(so_far, size);
    }
  }
  std::vector<Part> parts;
  for (std::uint32_t i = 0; i < scene_->instances.size(); ++i) {
    if (!used(i)) continue;
    const Mesh& mesh = scene_->meshes[scene_->instances[i].mesh];
    for (const Primitive& primitive : mesh.primitives)
      if (const Coverage coverage = coverages_.of(mesh, primitive); coverage != Coverage::nothing)
        parts.push_back({i, &primitive, coverage == Coverage::holes});
  }
  const auto place = [&](const Part& part) {
    return std::pair(largest[part.primitive->material], part.primitive->material);
  };
  std::stable_sort(parts.begin(), parts.end(),
                   [&](const Part& a, const Part& b) { return place(a) < place(b); });
  return parts;
}

void GpuScene::add_vertices() {
  std::size_t vertex_count = 0;
  for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
    first_vertex_.push_back(static_cast<std::uint32_t>(vertex_count));
    if (used(i)) vertex_count += scene_->meshes[scene_->instances[i].mesh].positions.size();
  }
  if (vertex_count > 0xfffffff0u) throw unsupported("the scene has more than 2^32 vertices");
  position_list_.reserve(vertex_count);
  surface_list_.resize(vertex_count * sizeof(SurfaceVertex));
  auto* surfaces = reinterpret_cast<SurfaceVertex*>(surface_list_.data());
  for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
    if (!used(i)) continue;
    const Instance& instance = scene_->instances[i];
    const Mesh& mesh = scene_->meshes[instance.mesh];
    for (const std::uint32_t vertex : order_of(instance.mesh).first_at)
      first_at_.push_back(first_vertex_[i] + vertex);
    const glm::dmat4 placed = world_from_object(static_cast<std::uint32_t>(i));
    const glm::dmat3 normal_matrix = glm::inverse(glm::transpose(glm::dmat3(placed)));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const glm::dvec3 normal = normal_matrix * glm::dvec3(mesh.normals[v]);
      const double length = glm::length(normal);
      SurfaceVertex& out = surfaces[position_list_.size()];
      out.normal =
          length > 0.0 && std::isfinite(length) ? glm::vec3(normal / length) : mesh.normals[v];
      out.uv = mesh.uvs.empty() ? glm::vec2(0.0f) : mesh.uvs[v];
      out.color = mesh.colors.empty() ? white : glm::packUnorm4x8(mesh.colors[v]);
      position_list_.push_back(glm::vec3(placed * glm::dvec4(mesh.positions[v], 1.0)));
    }
  }
}

glm::dmat4 GpuScene::world_from_object(std::uint32_t instance) const {
  glm::dmat4 placed = scene_->instances[instance].world_from_object;
  placed[3] -= glm::dvec4(frame_.origin, 0.0);
  return placed;
}

const TriangleOrder& GpuScene::order_of(std::uint32_t mesh) {
  const auto [order, is_new] = orders_.try_emplace(mesh);
  if (!is_new) return order->second;
  std::vector<bool> solid;
  for (const Primitive& primitive : scene_->meshes[mesh].primitives)
    solid.push_back(coverages_.of(scene_->meshes[mesh], primitive) == Coverage::solid);
  return order->second = triangle_order(scene_->meshes[mesh], solid);
}

void GpuScene::add_range(const Part& part) {
  const Instance& instance = scene_->instances[part.instance];
  const TriangleOrder& order = order_of(instance.mesh);
  const Primitive& primitive = *part.primitive;
  const auto own =
      static_cast<std::size_t>(&primitive - scene_->meshes[instance.mesh].primitives.data());
  DrawRange range;
  range.first_index = static_cast<std::uint32_t>(index_list_.size());
  range.material = primitive.material;
  range.instance = part.instance;
  range.visible = uses_[part.instance].visible;
  range.casts_shadow = uses_[part.instance].casts;
  range.double_sided = scene_->materials[primitive.material].double_sided;
  range.masked = part.holes;
  range.low = glm::vec3(std::numeric_limits<float>::max());
  range.high = -range.low;
  const bool mirrored = glm::determinant(glm::dmat3(instance.world_from_object)) < 0.0;
  for (std::uint32_t i = 0; i < primitive.index_count; ++i) {
    const std::uint32_t corner = i % 3;
    const std::uint32_t turned = mirrored && corner != 0 ? i - corner + 3 - corner : i;
    const std::uint32_t index =
        first_vertex_[part.instance] + order.corners[order.first[own] + turned];
    index_list_.push_back(index);
    const auto* surfaces = reinterpret_cast<const SurfaceVertex*>(surface_list_.data());
    range.colored = range.colored || surfaces[index].color != white;
    range.low = glm::min(range.low, position_list_[index]);
    range.high = glm::max(range.high, position_list_[index]);
  }
  // Holes are looked up by the corners that the mesh has.
  if (is_far() && !range.masked)
    split_long_triangles(range.first_index, part.instance);
  else
    range.closed_count = order.closed[own];
  range.index_count = static_cast<std::uint32_t>(index_list_.size()) - range.first_index;
  ranges_.push_back(range);
}

void GpuScene::split_long_triangles(std::uint32_t first_index, std::uint32_t instance) {
  const glm::dmat4 placed = world_from_object(instance);
  const Mesh& mesh = scene_->meshes[scene_->instances[instance].mesh];
  const auto surface = [&](std::uint32_t index) {
    return reinterpret_cast<SurfaceVertex*>(surface_list_.data()) + index;
  };
  const auto corner = [&](std::uint32_t index) {
    const glm::vec3& position = mesh.positions[index - first_vertex_[instance]];
    const SurfaceVertex& own = *surface(index);
    return FineVertex{glm::dvec3(placed * glm::dvec4(position, 1.0)), own.normal, own.uv,
                      glm::unpackUnorm4x8(own.color)};
  };
  // Beside the reach, floats of such an edge are as fine as the frame is made for.
  constexpr double short_share = 1.0 / 16.0;
  TriangleSplitter splitter(short_share * frame_.reach,
                            static_cast<std::uint32_t>(position_list_.size()), corner);
  std::vector<std::uint32_t> whole(index_list_.begin() + first_index, index_list_.end());
  index_list_.resize(first_index);
  for (std::size_t i = 0; i + 2 < whole.size(); i += 3)
    for (const auto& part : splitter.split({whole[i], whole[i + 1], whole[i + 2]}))
      index_list_.insert(index_list_.end(), part.begin(), part.end());
  for (const FineVertex& vertex : splitter.new_vertices()) {
    first_at_.push_back(static_cast<std::uint32_t>(position_list_.size()));
    position_list_.push_back(glm::vec3(vertex.position));
    surface_list_.resize(position_list_.size() * sizeof(SurfaceVertex));
    const float length = glm::length(vertex.normal);
    *surface(static_cast<std::uint32_t>(position_list_.size() - 1)) = {
        length > 0.0f ? vertex.normal / length : vertex.normal, vertex.uv,
        glm::packUnorm4x8(vertex.color), glm::vec3(0.0f)};
  }
}

void GpuScene::flatten() {
  add_vertices();
  for (const Part& part : find_parts())
    if (part.primitive->index_count > 0) add_range(part);
  // Bodies may have several materials.
  std::map<std::uint32_t, Bounds> bodies;
  for (const DrawRange& range : ranges_) bodies[range.instance].add(range.box());
  for (DrawRange& range : ranges_) range.body = bodies[range.instance];
}

std::vector<std::uint32_t> GpuScene::add_facets(std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> indices = index_list_;
  std::vector<bool> taken(positions.size());
  const auto surface = [&](std::uint32_t index) {
    return reinterpret_cast<SurfaceVertex*>(surface_list_.data()) + index;
  };
  for (const DrawRange& range : ranges_) {
    if (!range.visible) continue;
    for (std::uint32_t i = range.first_index; i < range.first_index + range.index_count; i += 3) {
      const std::array<std::uint32_t, 3> corner{index_list_[i], index_list_[i + 1],
                                                index_list_[i + 2]};
      const glm::vec3 facet =
          facet_normal({positions[corner[0]], positions[corner[1]], positions[corner[2]]},
                       {surface(corner[0]), surface(corner[1]), surface(corner[2])});
      std::uint32_t own = corner[0];
      if (taken[own] && surface(own)->facet != facet) {
        own = static_cast<std::uint32_t>(positions.size());
        positions.push_back(positions[corner[0]]);
        surface_list_.resize(surface_list_.size() + sizeof(SurfaceVertex));
        *surface(own) = *surface(corner[0]);
        indices[i] = own;
      } else {
        taken[own] = true;
      }
      surface(own)->facet = facet;
    }
  }
  return indices;
}

void GpuScene::meet_at_places() {
  for (const DrawRange& range : ranges_) {
    // Holes are looked up by what corners have of their own.
    if (range.masked) continue;
    for (std::uint32_t i = range.first_index; i < range.first_index + range.index_count; ++i)
      index_list_[i] = first_at_[index_list_[i]];
  }
}

bool GpuScene::emits() const {
  return std::any_of(ranges_.begin(), ranges_.end(), [&](const DrawRange& range) {
    return range.visible && scene_->materials[range.material].emissive != glm::vec3(0.0f);
  });
}

void GpuScene::upload_materials(vulkan::Device& device) {
  std::vector<shader::MaterialData> list;
  for (const Material& material : scene_->materials) {
    shader::MaterialData data{};
    data.base_color = glm::vec4(material.base_color, material.alpha);
    data.emissive = glm::vec4(material.emissive, 0.0f);
    data.surface = {material.specular, std::clamp(material.shininess, 1.0f, 1024.0f),
                    material.alpha_mode == AlphaMode::mask ? interpolated_cutoff(material) : 0.0f,
                    material.texture >= 0 ? 1.0f : 0.0f};
    list.push_back(data);
  }
  materials_ = upload(device, ledger_, "materials", list.data(), list.size() * sizeof(list[0]),
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  for (std::size_t i = 0; i < scene_->textures.size(); ++i)
    textures_.push_back(needed_textures_[i] ? upload_texture(device, ledger_, scene_->textures[i])
                                            : vulkan::Image());
  textures_.push_back(upload_texture(device, ledger_, {"white", 1, 1, {255, 255, 255, 255}}));
}

const vulkan::Image& GpuScene::texture_of(std::uint32_t material) const {
  const int texture = scene_->materials[material].texture;
  // A caster without holes is drawn without its texture.
  if (texture < 0 || !textures_[static_cast<std::size_t>(texture)]) return textures_.back();
  return textures_[static_cast<std::size_t>(texture)];
}

const SceneAdjacency& GpuScene::adjacency(vulkan::Device& device) const {
  if (!adjacency_) {
    auto made = std::make_unique<SceneAdjacency>();
    made->host = build_adjacency(position_list_, index_list_, ranges_);
    vulkan::MemoryLedger ledger;
    made->indices =
        upload(device, ledger, "adjacency", made->host.indices.data(),
               made->host.indices.size() * sizeof(std::uint32_t),
               VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    made->host.indices = {};
    adjacency_ = std::move(made);
  }
  return *adjacency_;
}

}  // namespace penumbra
