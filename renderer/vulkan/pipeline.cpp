#include "renderer/vulkan/pipeline.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

namespace penumbra::vulkan {
namespace {

std::string key_of(const ProgramSource& source) {
  std::ostringstream key;
  for (const auto& [stage, path] : source.stages) key << stage << path << '\n';
  key << source.preamble << '\n' << source.constants_from_vertex << '\n';
  return key.str();
}

void append(std::ostringstream& key, const StencilFace& face) {
  key << face.fail << ',' << face.depth_fail << ',' << face.pass << ',' << face.compare << ','
      << face.reference << ',' << face.compare_mask << ',' << face.write_mask << ';';
}

std::string key_of(const GraphicsState& state) {
  std::ostringstream key;
  for (const VkFormat format : state.color_formats) key << format << ',';
  key << ';' << state.depth_format << ',' << static_cast<int>(state.vertex_input) << ','
      << state.topology << ',' << state.cull << ',' << state.depth_test << state.depth_write << ','
      << state.depth_compare << ',' << state.depth_clamp << static_cast<int>(state.blend)
      << state.color_write << state.stencil_test << ';';
  append(key, state.stencil_front);
  append(key, state.stencil_back);
  return key.str();
}

VkStencilOpState stencil_state(const StencilFace& face) {
  return {face.fail,         face.pass,       face.depth_fail, face.compare,
          face.compare_mask, face.write_mask, face.reference};
}

struct VertexLayout {
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
};

/// Positions have a buffer of their own, so that passes which need nothing else read nothing
/// else.
VertexLayout vertex_layout(VertexInput input) {
  VertexLayout layout;
  if (input == VertexInput::none) return layout;
  layout.bindings.push_back({0, 12, VK_VERTEX_INPUT_RATE_VERTEX});
  layout.attributes.push_back({0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0});
  if (input == VertexInput::surface) {
    layout.bindings.push_back({1, 36, VK_VERTEX_INPUT_RATE_VERTEX});
    layout.attributes.push_back({1, 1, VK_FORMAT_R32G32B32_SFLOAT, 0});
    layout.attributes.push_back({2, 1, VK_FORMAT_R32G32_SFLOAT, 12});
    layout.attributes.push_back({3, 1, VK_FORMAT_R8G8B8A8_UNORM, 20});
    layout.attributes.push_back({4, 1, VK_FORMAT_R32G32B32_SFLOAT, 24});
  }
  return layout;
}

/// A GraphicsState as Vulkan takes it. Its parts point at each other: it stays where it is.
class FixedFunctions {
 public:
  explicit FixedFunctions(const GraphicsState& state)
      : vertices_(vertex_layout(state.vertex_input)), color_formats_(state.color_formats) {
    vertex.vertexBindingDescriptionCount = static_cast<std::uint32_t>(vertices_.bindings.size());
    vertex.pVertexBindingDescriptions = vertices_.bindings.data();
    vertex.vertexAttributeDescriptionCount =
        static_cast<std::uint32_t>(vertices_.attributes.size());
    vertex.pVertexAttributeDescriptions = vertices_.attributes.data();
    assembly.topology = state.topology;
    viewport.viewportCount = viewport.scissorCount = 1;
    raster.depthClampEnable = state.depth_clamp;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1.0f;
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    depth.depthTestEnable = state.depth_test;
    depth.depthWriteEnable = state.depth_write;
    depth.depthCompareOp = state.depth_compare;
    depth.stencilTestEnable = state.stencil_test;
    depth.front = stencil_state(state.stencil_front);
    depth.back = stencil_state(state.stencil_back);
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
    dynamic.pDynamicStates = dynamic_states.data();
    set_attachments(state);
  }
  FixedFunctions(const FixedFunctions&) = delete;
  FixedFunctions& operator=(const FixedFunctions&) = delete;

  VkPipelineVertexInputStateCreateInfo vertex{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  VkPipelineRasterizationStateCreateInfo raster{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  VkPipelineMultisampleStateCreateInfo multisample{
      VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  VkPipelineDepthStencilStateCreateInfo depth{
      VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineColorBlendStateCreateInfo blend{
      VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};

 private:
  /// Cull mode is set per draw: one pipeline serves single-sided and double-sided materials.
  static constexpr std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                             VK_DYNAMIC_STATE_CULL_MODE};

  void set_attachments(const GraphicsState& state) {
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.blendEnable = state.blend == Blend::add;
    attachment.srcColorBlendFactor = attachment.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    attachment.srcAlphaBlendFactor = attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    attachment.colorBlendOp = attachment.alphaBlendOp = VK_BLEND_OP_ADD;
    attachment.colorWriteMask = state.color_write ? 0xfu : 0u;
    attachments_.assign(color_formats_.size(), attachment);
    blend.attachmentCount = static_cast<std::uint32_t>(attachments_.size());
    blend.pAttachments = attachments_.data();
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(color_formats_.size());
    rendering.pColorAttachmentFormats = color_formats_.data();
    if (has_depth(state.depth_format)) rendering.depthAttachmentFormat = state.depth_format;
    if (has_stencil(state.depth_format)) rendering.stencilAttachmentFormat = state.depth_format;
  }

  VertexLayout vertices_;
  std::vector<VkFormat> color_formats_;
  std::vector<VkPipelineColorBlendAttachmentState> attachments_;
};

/// Shader modules live only while a pipeline is made of them.
class StageList {
 public:
  StageList(VkDevice device, const CompiledProgram& program) : device_(device) {
    for (const auto& [stage, words] : program.spirv) {
      VkShaderModuleCreateInfo module{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
      module.codeSize = words.size() * sizeof(words[0]);
      module.pCode = words.data();
      VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
      info.stage = stage;
      info.pName = "main";
      check(vkCreateShaderModule(device, &module, nullptr, &info.module), "vkCreateShaderModule");
      stages.push_back(info);
    }
  }
  ~StageList() {
    for (const auto& stage : stages) vkDestroyShaderModule(device_, stage.module, nullptr);
  }
  StageList(const StageList&) = delete;
  StageList& operator=(const StageList&) = delete;
  std::vector<VkPipelineShaderStageCreateInfo> stages;

 private:
  VkDevice device_;
};

}  // namespace

void Bindings::texture(const std::string& name, const Image& image, Sampling sampling) {
  Entry entry;
  entry.image = {VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_GENERAL};
  entry.sampling = sampling;
  entries_[name] = entry;
}

void Bindings::stencil(const std::string& name, const Image& image) {
  Entry entry;
  entry.image = {VK_NULL_HANDLE, image.stencil_view(), VK_IMAGE_LAYOUT_GENERAL};
  entries_[name] = entry;
}

void Bindings::texture_slice(const std::string& name, const Image& image, std::uint32_t layer,
                             std::uint32_t level, Sampling sampling) {
  Entry entry;
  entry.image = {VK_NULL_HANDLE, image.slice(layer, level), VK_IMAGE_LAYOUT_GENERAL};
  entry.sampling = sampling;
  entries_[name] = entry;
}

void Bindings::storage_image(const std::string& name, const Image& image) {
  texture(name, image, Sampling::nearest);
}

void Bindings::storage_slice(const std::string& name, const Image& image, std::uint32_t layer,
                             std::uint32_t level) {
  texture_slice(name, image, layer, level, Sampling::nearest);
}

void Bindings::buffer(const std::string& name, BufferRange range) {
  Entry entry;
  entry.buffer = {range.buffer, range.offset, range.size};
  entries_[name] = entry;
}

void Bindings::texel_buffer(const std::string& name, VkBufferView view) {
  Entry entry;
  entry.view = view;
  entries_[name] = entry;
}

void Bindings::add(const Bindings& others) {
  for (const auto& [name, entry] : others.entries_) entries_[name] = entry;
}

PipelineCache::PipelineCache(Device& device, const ShaderLibrary& library)
    : device_(device), library_(library) {}

std::unique_ptr<Pipeline> PipelineCache::start(const ProgramSource& source) {
  auto made = std::make_unique<Pipeline>();
  ProgramSource own = source;
  if (device_.finds_levels_by_lane()) own.preamble = "#define SAMPLES_TEXELS\n" + own.preamble;
  made->program = compile(library_, own);
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const auto& reflected : made->program.bindings)
    bindings.push_back(
        {reflected.binding, reflected.type, reflected.count, reflected.stages, nullptr});
  VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set_info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set_info.pBindings = bindings.data();
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(device_.handle, &set_info, nullptr, &set_layout),
        "vkCreateDescriptorSetLayout");
  made->set_layout = {device_.handle, set_layout};

  VkPushConstantRange constants{0, 0, 128};
  for (const auto& [stage, words] : made->program.spirv) constants.stageFlags |= stage;
  VkPipelineLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = made->set_layout.address();
  layout_info.pushConstantRangeCount = made->program.push_constants ? 1 : 0;
  layout_info.pPushConstantRanges = &constants;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(device_.handle, &layout_info, nullptr, &layout),
        "vkCreatePipelineLayout");
  made->layout = {device_.handle, layout};
  return made;
}

PipelineCache::Slot& PipelineCache::slot_of(const std::string& key) {
  Slot& slot = pipelines_[key];
  slot.used = ++uses_;
  return slot;
}

void PipelineCache::trim() {
  if (pipelines_.size() <= most_kept) return;
  std::vector<std::uint64_t> uses;
  for (const auto& [key, slot] : pipelines_) uses.push_back(slot.used);
  const auto oldest_kept = uses.end() - static_cast<std::ptrdiff_t>(most_kept);
  std::nth_element(uses.begin(), oldest_kept, uses.end());
  std::erase_if(pipelines_, [&](const auto& entry) { return entry.second.used < *oldest_kept; });
}

const Pipeline& PipelineCache::graphics(const ProgramSource& source, const GraphicsState& state) {
  auto& slot = slot_of(key_of(source) + key_of(state)).pipeline;
  if (slot) return *slot;
  auto made = start(source);
  const StageList stages(device_.handle, made->program);
  const FixedFunctions fixed(state);
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.pNext = &fixed.rendering;
  info.stageCount = static_cast<std::uint32_t>(stages.stages.size());
  info.pStages = stages.stages.data();
  info.pVertexInputState = &fixed.vertex;
  info.pInputAssemblyState = &fixed.assembly;
  info.pViewportState = &fixed.viewport;
  info.pRasterizationState = &fixed.raster;
  info.pMultisampleState = &fixed.multisample;
  info.pDepthStencilState = &fixed.depth;
  info.pColorBlendState = &fixed.blend;
  info.pDynamicState = &fixed.dynamic;
  info.layout = made->layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device_.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines");
  made->pipeline = {device_.handle, pipeline};
  slot = std::move(made);
  return *slot;
}

const Pipeline& PipelineCache::compute(const std::string& path, const std::string& preamble) {
  ProgramSource source;
  source.stages[VK_SHADER_STAGE_COMPUTE_BIT] = path;
  source.preamble = preamble;
  auto& slot = slot_of(key_of(source)).pipeline;
  if (slot) return *slot;
  auto made = start(source);
  made->compute = true;
  const StageList stages(device_.handle, made->program);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stages.stages.front();
  info.layout = made->layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device_.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateComputePipelines");
  made->pipeline = {device_.handle, pipeline};
  slot = std::move(made);
  return *slot;
}

VkSampler PipelineCache::sampler(Sampling sampling) {
  auto& slot = samplers_[sampling];
  if (slot != VK_NULL_HANDLE) return slot;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  const bool nearest = sampling == Sampling::nearest;
  info.magFilter = info.minFilter = nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  const bool mipmapped = sampling == Sampling::linear_repeat ||
                         sampling == Sampling::linear_mipmapped ||
                         sampling == Sampling::anisotropic;
  info.mipmapMode = mipmapped ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.maxLod = VK_LOD_CLAMP_NONE;
  info.addressModeU = info.addressModeV = info.addressModeW =
      sampling == Sampling::linear_repeat ? VK_SAMPLER_ADDRESS_MODE_REPEAT
                                          : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  if (sampling == Sampling::anisotropic && device_.features.samplerAnisotropy) {
    info.anisotropyEnable = VK_TRUE;
    info.maxAnisotropy = device_.properties.limits.maxSamplerAnisotropy;
  }
  if (sampling == Sampling::compare_less_or_equal) {
    info.compareEnable = VK_TRUE;
    info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  }
  VkSampler made = VK_NULL_HANDLE;
  check(vkCreateSampler(device_.handle, &info, nullptr, &made), "vkCreateSampler");
  slot = {device_.handle, made};
  return slot;
}

void PipelineCache::push(VkCommandBuffer commands, const Pipeline& pipeline,
                         const Bindings& bindings) {
  const auto& reflected = pipeline.program.bindings;
  std::vector<VkDescriptorImageInfo> images(reflected.size());
  std::vector<VkWriteDescriptorSet> writes;
  writes.reserve(reflected.size());
  for (std::size_t i = 0; i < reflected.size(); ++i) {
    const auto found = bindings.entries().find(reflected[i].name);
    if (found == bindings.entries().end())
      throw std::logic_error("a shader reads " + reflected[i].name + ", which is not bound");
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstBinding = reflected[i].binding;
    write.descriptorCount = 1;
    write.descriptorType = reflected[i].type;
    images[i] = found->second.image;
    if (reflected[i].type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)
      images[i].sampler = sampler(found->second.sampling);
    write.pImageInfo = &images[i];
    write.pBufferInfo = &found->second.buffer;
    write.pTexelBufferView = &found->second.view;
    writes.push_back(write);
  }
  if (!writes.empty())
    device_.push_descriptors(
        commands,
        pipeline.compute ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS,
        pipeline.layout, 0, static_cast<std::uint32_t>(writes.size()), writes.data());
}

}  // namespace penumbra::vulkan
