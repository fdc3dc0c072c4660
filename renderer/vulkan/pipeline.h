#pragma once

#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "renderer/vulkan/memory.h"
#include "renderer/vulkan/shader_compiler.h"

namespace penumbra::vulkan {

enum class Sampling {
  nearest,                ///< clamped to the edge
  linear,                 ///< clamped to the edge
  linear_repeat,          ///< surface textures: trilinear, repeating
  linear_mipmapped,       ///< trilinear, clamped to the edge
  anisotropic,            ///< 16x anisotropic trilinear, clamped to the edge
  compare_less_or_equal,  ///< bilinear depth comparison: 1 where reference <= texel
};

/// Shader resources by name. Later settings of a name replace earlier ones.
class Bindings {
 public:
  void texture(const std::string& name, const Image& image, Sampling sampling);
  void stencil(const std::string& name, const Image& image);  ///< the stencil aspect, usampler2D
  void texture_slice(const std::string& name, const Image& image, std::uint32_t layer,
                     std::uint32_t level, Sampling sampling);
  void storage_image(const std::string& name, const Image& image);  ///< all layers of level 0
  void storage_slice(const std::string& name, const Image& image, std::uint32_t layer,
                     std::uint32_t level = 0);
  void buffer(const std::string& name, BufferRange range);  ///< uniform or storage, as declared
  void texel_buffer(const std::string& name, VkBufferView view);

  struct Entry {
    VkDescriptorImageInfo image{};
    VkDescriptorBufferInfo buffer{};
    VkBufferView view = VK_NULL_HANDLE;
    Sampling sampling = Sampling::nearest;
  };
  const std::map<std::string, Entry>& entries() const { return entries_; }
  void add(const Bindings& others);

 private:
  std::map<std::string, Entry> entries_;
};

enum class VertexInput { none, position, surface };  // surface: position, normal, uv, colour, facet
enum class Blend { off, add };

struct StencilFace {
  VkStencilOp fail = VK_STENCIL_OP_KEEP;
  VkStencilOp depth_fail = VK_STENCIL_OP_KEEP;
  VkStencilOp pass = VK_STENCIL_OP_KEEP;
  VkCompareOp compare = VK_COMPARE_OP_ALWAYS;
  std::uint32_t reference = 0;
  std::uint32_t compare_mask = 0xff;  ///< bits that are compared
  std::uint32_t write_mask = 0xff;    ///< bits that change
};

/// Fixed-function state of a graphics pipeline. Front faces are counter-clockwise in the picture.
struct GraphicsState {
  std::vector<VkFormat> color_formats;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;  ///< with stencil where the format has it
  VertexInput vertex_input = VertexInput::none;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  bool depth_test = false;
  bool depth_write = false;
  VkCompareOp depth_compare = VK_COMPARE_OP_GREATER;  ///< the camera's depth is reversed: 1 is near
  bool depth_clamp = false;
  Blend blend = Blend::off;
  bool color_write = true;
  bool stencil_test = false;
  StencilFace stencil_front;
  StencilFace stencil_back;
};

struct Pipeline {
  CompiledProgram program;
  Owned<VkDescriptorSetLayout> set_layout;
  Owned<VkPipelineLayout> layout;
  Owned<VkPipeline> pipeline;
  bool compute = false;
};

/// Compiles programs and keeps the pipelines that were used last.
class PipelineCache {
 public:
  /// Pipelines that `trim` leaves; a picture takes about ten. One takes megabytes on lavapipe.
  static constexpr std::size_t most_kept = 128;

  PipelineCache(Device& device, const ShaderLibrary& library);

  /// The key is the source and state themselves: equal input gives the same pipeline.
  const Pipeline& graphics(const ProgramSource& source, const GraphicsState& state);
  const Pipeline& compute(const std::string& path, const std::string& preamble = {});

  /// Between pictures: forgets what was not used for longest.
  void trim();
  std::size_t size() const { return pipelines_.size(); }

  VkSampler sampler(Sampling sampling);
  const ShaderLibrary& library() const { return library_; }

  /// Fills every descriptor of `pipeline` from `bindings` and pushes them. Throws std::logic_error
  /// naming a resource that the shader reads and that is not bound.
  void push(VkCommandBuffer commands, const Pipeline& pipeline, const Bindings& bindings);

 private:
  struct Slot {
    std::unique_ptr<Pipeline> pipeline;
    std::uint64_t used = 0;  ///< when last, in uses of any
  };

  std::unique_ptr<Pipeline> start(const ProgramSource& source);
  Slot& slot_of(const std::string& key);

  Device& device_;
  const ShaderLibrary& library_;
  std::unordered_map<std::string, Slot> pipelines_;
  std::uint64_t uses_ = 0;
  std::map<Sampling, Owned<VkSampler>> samplers_;
};

}  // namespace penumbra::vulkan
