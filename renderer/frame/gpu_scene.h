#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <typeindex>
#include <vector>

#include "renderer/frame/adjacency.h"
#include "renderer/frame/triangle_order.h"
#include "renderer/plan/plan.h"
#include "renderer/scene/coverage.h"
#include "renderer/scene/scene.h"
#include "renderer/vulkan/commands.h"

namespace penumbra {

/// Triangles of one material and instance: a range of the index buffer with its box.
struct DrawRange {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::uint32_t closed_count = 0;  ///< of its first indices: those of closed bodies
  std::uint32_t material = 0;
  std::uint32_t instance = 0;
  glm::vec3 low{0.0f};  ///< box, world
  glm::vec3 high{0.0f};
  Bounds box() const { return {low, high}; }
  Bounds body;               ///< around all ranges of the instance, world
  bool visible = true;       ///< as the plan has it
  bool casts_shadow = true;  ///< as the plan has it
  bool double_sided = false;
  bool masked = false;   ///< has holes
  bool colored = false;  ///< its corners have colours of their own
};

/// The origin of coordinates on the device, and how far from it surfaces matter.
struct SceneFrame {
  glm::dvec3 origin{0.0};
  /// Maps, volumes and tolerances are fitted to what lies no farther from the origin along any
  /// axis, metres. Infinite where that is everything.
  double reach = std::numeric_limits<double>::infinity();

  friend bool operator==(const SceneFrame&, const SceneFrame&) = default;
};

/// The middle of the scene, as long as floats counted from there are fine enough for what the
/// camera sees; the camera's place where the scene reaches too far for that.
SceneFrame scene_frame(const Scene& scene, const Camera& camera);

/// A scene on the device, flattened: every instance's triangles are in world space in one vertex
/// and one index buffer, sorted by material. World space here is the scene's moved by -origin, so
/// that rasteriser, silhouettes and ray intersection share the very same float positions.
class GpuScene {
 public:
  /// Uploads what is used: instances that are visible or cast, textures whose flag is set.
  GpuScene(vulkan::Device& device, std::shared_ptr<const Scene> scene,
           std::vector<InstanceUse> uses, std::vector<bool> textures, const SceneFrame& frame);

  const Scene& scene() const { return *scene_; }
  /// Whether this is what such a plan needs, no more and no less.
  bool serves(const std::shared_ptr<const Scene>& scene, const std::vector<InstanceUse>& uses,
              const std::vector<bool>& textures, const SceneFrame& frame) const {
    return scene_ == scene && uses_ == uses && needed_textures_ == textures && frame_ == frame;
  }
  glm::dvec3 origin() const { return frame_.origin; }
  glm::vec3 to_world(const glm::dvec3& scene_point) const {
    return glm::vec3(scene_point - frame_.origin);
  }
  /// Box around the whole scene, used or not, as far as the frame reaches; world.
  glm::vec3 low() const { return low_; }
  glm::vec3 high() const { return high_; }
  /// A power of two near one over the scene's size, 1/m: scales lengths without rounding, so that
  /// products of them stay within floats.
  float inverse_size() const;
  /// Whether parts of the scene lie beyond the frame's reach.
  bool is_far() const { return std::isfinite(frame_.reach); }
  /// The part of a box in the scene's coordinates that lies within reach, in world space; may be
  /// empty.
  Bounds near_part(const Bounds& box) const;
  /// Whether anything visible emits light.
  bool emits() const;
  /// What this scene loses by single precision, shown with the result.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Of an instance that is used: its first vertex among positions().
  std::uint32_t first_vertex(std::uint32_t instance) const { return first_vertex_[instance]; }

  const std::vector<glm::vec3>& positions() const { return position_list_; }
  /// Corners that lie at one place of an instance are one, but where there are holes.
  const std::vector<std::uint32_t>& indices() const { return index_list_; }
  const std::vector<DrawRange>& ranges() const { return ranges_; }

  const vulkan::Buffer& position_buffer() const { return positions_; }
  const vulkan::Buffer& surface_buffer() const { return surfaces_; }
  const vulkan::Buffer& index_buffer() const { return indices_; }
  /// The same triangles for drawing surfaces: corners have attributes of their own, and the first
  /// tells the facet.
  const vulkan::Buffer& surface_index_buffer() const { return surface_indices_; }
  const vulkan::Buffer& material_buffer() const { return materials_; }
  /// White where the material has no texture.
  const vulkan::Image& texture_of(std::uint32_t material) const;

  /// Built and uploaded when first asked for, then kept with the scene. Not charged here, but to
  /// the technique that requires it.
  const SceneAdjacency& adjacency(vulkan::Device& device) const;

  /// Something else derived from the scene alone, by its type: made by `make`, which returns a
  /// shared_ptr<const T>, when first asked for, and kept with the scene. Where T names a
  /// `requirement` of a technique, derived_memory tells what T::memory() does.
  template <class T, class Make>
  const T& derived(const Make& make) const {
    std::shared_ptr<const void>& slot = derived_[typeid(T)];
    if (!slot) {
      const auto made = std::shared_ptr<const T>(make());
      if constexpr (requires { T::requirement; }) derived_memory_[T::requirement] = made->memory();
      slot = made;
    }
    return *static_cast<const T*>(slot.get());
  }
  /// Device memory of what was derived for a requirement; nothing before it is made.
  std::vector<ResourceCost> derived_memory(const std::string& requirement) const {
    const auto found = derived_memory_.find(requirement);
    return found == derived_memory_.end() ? std::vector<ResourceCost>{} : found->second;
  }

 private:
  /// Triangles of one instance and material that cover anything.
  struct Part {
    std::uint32_t instance;
    const Primitive* primitive;
    bool holes;  ///< its texture has some
  };
  /// By material; those that large things have last, which then are mostly hidden.
  std::vector<Part> find_parts();
  void add_vertices();
  const TriangleOrder& order_of(std::uint32_t mesh);
  void add_range(const Part& part);
  /// Parts of triangles that pass the origin closer than their corners' floats bear, in place of
  /// them, from an index on.
  void split_long_triangles(std::uint32_t first_index, std::uint32_t instance);
  /// From an instance's coordinates to this scene's.
  glm::dmat4 world_from_object(std::uint32_t instance) const;
  void flatten();
  bool used(std::size_t instance) const { return uses_[instance].visible || uses_[instance].casts; }
  /// Gives every visible triangle's first corner the facet's normal. Where one vertex begins
  /// several triangles it is repeated at the end of `positions` and of the surfaces; returns the
  /// indices of all triangles with these.
  std::vector<std::uint32_t> add_facets(std::vector<glm::vec3>& positions);
  void meet_at_places();
  void upload_materials(vulkan::Device& device);
  void find_coarse_coordinates();

  std::shared_ptr<const Scene> scene_;
  std::vector<InstanceUse> uses_;
  std::vector<bool> needed_textures_;
  SceneFrame frame_;
  std::vector<std::string> notes_;
  std::vector<std::uint32_t> first_vertex_;  ///< by instance
  glm::vec3 low_{0.0f};
  glm::vec3 high_{0.0f};
  std::vector<glm::vec3> position_list_;
  std::vector<std::uint32_t> index_list_;
  std::vector<DrawRange> ranges_;
  Coverages coverages_;
  // Freed after upload.
  std::vector<std::byte> surface_list_;
  std::map<std::uint32_t, TriangleOrder> orders_;  ///< by mesh
  std::vector<std::uint32_t> first_at_;            ///< by vertex, the instance's first at its place
  vulkan::MemoryLedger ledger_;
  vulkan::Buffer positions_, surfaces_, indices_, surface_indices_, materials_;
  std::vector<vulkan::Image> textures_;  ///< one per scene texture, empty where unused, then white
  mutable std::map<std::type_index, std::shared_ptr<const void>> derived_;
  mutable std::map<std::string, std::vector<ResourceCost>> derived_memory_;  ///< by requirement
  mutable std::unique_ptr<SceneAdjacency> adjacency_;
};

/// Device buffer with this content, by way of a staging buffer.
vulkan::Buffer upload(vulkan::Device& device, vulkan::MemoryLedger& ledger, const std::string& name,
                      const void* data, std::size_t bytes, VkBufferUsageFlags usage);

/// sRGB texture with a full mip chain.
vulkan::Image upload_texture(vulkan::Device& device, vulkan::MemoryLedger& ledger,
                             const Texture& texture);

}  // namespace penumbra
