#include "renderer/vulkan/commands.h"

#include <algorithm>
#include <chrono>

namespace penumbra::vulkan {
namespace {

constexpr VkQueryPipelineStatisticFlags counted_statistics =
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_PRIMITIVES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT;

void begin_commands(VkCommandBuffer commands) {
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
}

void submit_and_wait(Device& device, VkCommandBuffer commands, VkFence fence) {
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  buffer.commandBuffer = commands;
  VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &buffer;
  check(vkQueueSubmit2(device.queue, 1, &submit, fence), "vkQueueSubmit2");
  check(vkWaitForFences(device.handle, 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device.handle, 1, &fence), "vkResetFences");
}

Owned<VkFence> make_fence(Device& device) {
  VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  check(vkCreateFence(device.handle, &info, nullptr, &fence), "vkCreateFence");
  return {device.handle, fence};
}

Owned<VkCommandPool> make_pool(Device& device) {
  VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  info.queueFamilyIndex = device.queue_family;
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device.handle, &info, nullptr, &pool), "vkCreateCommandPool");
  return {device.handle, pool};
}

VkCommandBuffer make_commands(Device& device, VkCommandPool pool) {
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device.handle, &info, &commands), "vkAllocateCommandBuffers");
  return commands;
}

Owned<VkQueryPool> make_queries(Device& device, VkQueryType type, std::uint32_t count) {
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = type;
  info.queryCount = count;
  if (type == VK_QUERY_TYPE_PIPELINE_STATISTICS) info.pipelineStatistics = counted_statistics;
  VkQueryPool pool = VK_NULL_HANDLE;
  check(vkCreateQueryPool(device.handle, &info, nullptr, &pool), "vkCreateQueryPool");
  return {device.handle, pool};
}

}  // namespace

void global_barrier(VkCommandBuffer commands) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

void run_now(Device& device, const std::function<void(VkCommandBuffer)>& record) {
  Device::OneTimeWork& kept = device.one_time;
  if (kept.commands == VK_NULL_HANDLE) {
    kept.pool = make_pool(device);
    kept.fence = make_fence(device);
    kept.commands = make_commands(device, kept.pool);
  }
  begin_commands(kept.commands);
  record(kept.commands);
  global_barrier(kept.commands);
  submit_and_wait(device, kept.commands, kept.fence);
}

void Commands::begin_rendering(const RenderTargets& targets) {
  std::vector<VkRenderingAttachmentInfo> colors;
  for (const ColorTarget& target : targets.colors) {
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    color.imageView = target.view;
    color.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    color.loadOp = target.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    color.clearValue.color = target.clear_value;
    colors.push_back(color);
  }
  VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  depth.imageView = targets.depth;
  depth.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  depth.loadOp = targets.clear_depth ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
  depth.storeOp =
      targets.depth_read_only ? VK_ATTACHMENT_STORE_OP_NONE : VK_ATTACHMENT_STORE_OP_STORE;
  depth.clearValue.depthStencil = {targets.depth_clear_value, 0};
  VkRenderingAttachmentInfo stencil = depth;
  stencil.loadOp = targets.clear_stencil ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
  stencil.clearValue.depthStencil = {0.0f, targets.stencil_clear_value};

  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea.extent = {targets.width, targets.height};
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  rendering.pColorAttachments = colors.data();
  if (targets.depth != VK_NULL_HANDLE && has_depth(targets.depth_format))
    rendering.pDepthAttachment = &depth;
  if (targets.depth != VK_NULL_HANDLE && has_stencil(targets.depth_format))
    rendering.pStencilAttachment = &stencil;
  vkCmdBeginRendering(commands_, &rendering);
  viewport(0.0f, 0.0f, static_cast<float>(targets.width), static_cast<float>(targets.height));
  cull(VK_CULL_MODE_NONE);
}

void Commands::end_rendering() {
  vkCmdEndRendering(commands_);
}

void Commands::viewport(float x, float y, float width, float height) {
  const VkViewport view{x, y, width, height, 0.0f, 1.0f};
  const VkRect2D scissor{{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                         {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}};
  vkCmdSetViewport(commands_, 0, 1, &view);
  vkCmdSetScissor(commands_, 0, 1, &scissor);
}

void Commands::cull(VkCullModeFlags mode) {
  vkCmdSetCullMode(commands_, mode);
}

void Commands::bind(const Pipeline& pipeline, const Bindings& bindings) {
  const auto point =
      pipeline.compute ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
  if (bound_ != &pipeline) vkCmdBindPipeline(commands_, point, pipeline.pipeline);
  bound_ = &pipeline;
  cache_.push(commands_, pipeline, bindings);
}

void Commands::push_constants(const void* data, std::uint32_t bytes) {
  VkShaderStageFlags stages = 0;
  for (const auto& [stage, words] : bound_->program.spirv) stages |= stage;
  vkCmdPushConstants(commands_, bound_->layout, stages, 0, bytes, data);
}

void Commands::draw(std::uint32_t vertices, std::uint32_t instances) {
  vkCmdDraw(commands_, vertices, instances, 0, 0);
}

void Commands::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  vkCmdDispatch(commands_, x, y, z);
}

void Commands::dispatch_indirect(const Buffer& arguments) {
  vkCmdDispatchIndirect(commands_, arguments.handle(), 0);
}

void Commands::barrier() {
  global_barrier(commands_);
}

Recorder::Recorder(Device& device, PipelineCache& cache)
    : device_(device),
      cache_(cache),
      pool_(make_pool(device)),
      commands_(make_commands(device, pool_)),
      fence_(make_fence(device)),
      timestamps_(make_queries(device, VK_QUERY_TYPE_TIMESTAMP, max_passes + 1)),
      statistics_(make_queries(device, VK_QUERY_TYPE_PIPELINE_STATISTICS, max_passes)) {}

void Recorder::begin(bool count_statistics) {
  // A render that was cancelled or failed may have left its recording behind.
  check(vkResetCommandBuffer(commands_, 0), "vkResetCommandBuffer");
  count_statistics_ = count_statistics;
  names_.clear();
  begin_commands(commands_);
  vkCmdResetQueryPool(commands_, timestamps_, 0, max_passes + 1);
  if (count_statistics_) vkCmdResetQueryPool(commands_, statistics_, 0, max_passes);
  global_barrier(commands_);
  timestamp();
}

void Recorder::timestamp() {
  const auto index = static_cast<std::uint32_t>(names_.size());
  vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps_, index);
  global_barrier(commands_);
}

void Recorder::pass(const std::string& name, const std::function<void(Commands&)>& record) {
  if (names_.size() == max_passes) flush();
  const auto index = static_cast<std::uint32_t>(names_.size());
  if (device_.begin_label != nullptr) {
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name.c_str();
    device_.begin_label(commands_, &label);
  }
  if (count_statistics_) vkCmdBeginQuery(commands_, statistics_, index, 0);
  Commands commands(device_, cache_, commands_);
  record(commands);
  if (count_statistics_) vkCmdEndQuery(commands_, statistics_, index);
  if (device_.end_label != nullptr) device_.end_label(commands_);
  names_.push_back(name);
  timestamp();
}

void Recorder::flush() {
  end();
  begin(count_statistics_);
}

void Recorder::end() {
  const auto start = std::chrono::steady_clock::now();
  submit_and_wait(device_, commands_, fence_);
  wall_ms_ +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  collect();
}

PassRecord& Recorder::record_of(const std::string& name) {
  const auto found = std::find_if(records_.begin(), records_.end(),
                                  [&](const auto& record) { return record.name == name; });
  if (found != records_.end()) return *found;
  records_.push_back({});
  records_.back().name = name;
  return records_.back();
}

void Recorder::collect() {
  if (names_.empty()) return;
  const auto count = static_cast<std::uint32_t>(names_.size());
  std::vector<std::uint64_t> times(count + 1);
  check(vkGetQueryPoolResults(device_.handle, timestamps_, 0, count + 1, times.size() * 8,
                              times.data(), 8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  std::vector<std::array<std::uint64_t, 8>> counters(count);
  if (count_statistics_)
    check(vkGetQueryPoolResults(device_.handle, statistics_, 0, count, counters.size() * 64,
                                counters.data(), 64,
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
  const double ms_per_tick = device_.properties.limits.timestampPeriod * 1e-6;
  for (std::uint32_t i = 0; i < count; ++i) {
    PassRecord& record = record_of(names_[i]);
    record.ms += static_cast<double>(times[i + 1] - times[i]) * ms_per_tick;
    record.counted = record.counted || count_statistics_;
    for (std::size_t c = 0; c < counters[i].size(); ++c) record.counters[c] += counters[i][c];
  }
}

void Recorder::clear_records() {
  records_.clear();
  wall_ms_ = 0.0;
}

}  // namespace penumbra::vulkan
