#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "renderer/vulkan/pipeline.h"

namespace penumbra::vulkan {

/// Records and runs a command buffer of its own, and waits for it: for uploads and set-up.
void run_now(Device& device, const std::function<void(VkCommandBuffer)>& record);

/// Everything before is finished and visible to everything after. Not inside a rendering.
void global_barrier(VkCommandBuffer commands);

struct ColorTarget {
  VkImageView view = VK_NULL_HANDLE;
  bool clear = false;
  VkClearColorValue clear_value{};
};

/// Attachments of a rendering. Depth and stencil are kept unless cleared.
struct RenderTargets {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<ColorTarget> colors;
  VkImageView depth = VK_NULL_HANDLE;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool depth_read_only = false;  ///< tested and left as it is, so that shaders may read it too
  bool clear_depth = false;
  float depth_clear_value = 0.0f;
  bool clear_stencil = false;
  std::uint32_t stencil_clear_value = 0;
};

/// Recording inside a pass.
class Commands {
 public:
  Commands(Device& device, PipelineCache& cache, VkCommandBuffer commands)
      : device_(device), cache_(cache), commands_(commands) {}

  VkCommandBuffer handle() const { return commands_; }
  void begin_rendering(const RenderTargets& targets);
  void end_rendering();
  void viewport(float x, float y, float width, float height);  ///< with a scissor of the same box
  void cull(VkCullModeFlags mode);
  void bind(const Pipeline& pipeline, const Bindings& bindings);
  template <class T>
  void constants(const T& value) {
    static_assert(sizeof(T) <= 128, "push constants hold 128 bytes");
    push_constants(&value, sizeof(T));
  }
  void draw(std::uint32_t vertices, std::uint32_t instances = 1);
  void full_screen_triangle() { draw(3); }
  void dispatch(std::uint32_t x, std::uint32_t y = 1, std::uint32_t z = 1);
  /// With the groups that the first three words of `arguments` tell when it runs.
  void dispatch_indirect(const Buffer& arguments);
  void barrier();  ///< global_barrier

 private:
  void push_constants(const void* data, std::uint32_t bytes);
  Device& device_;
  PipelineCache& cache_;
  VkCommandBuffer commands_;
  const Pipeline* bound_ = nullptr;
};

/// Device time and counters of passes of one name, summed over the frame.
struct PassRecord {
  std::string name;
  double ms = 0.0;
  bool counted = false;                     ///< counters below were measured
  std::array<std::uint64_t, 8> counters{};  ///< in the order of PassCost's counts
};

/// Records passes in order and measures each. Timestamps are taken at ALL_COMMANDS with a global
/// barrier after them, outside renderings: the only placement that charges the right pass on
/// lavapipe.
class Recorder {
 public:
  Recorder(Device& device, PipelineCache& cache);

  void begin(bool count_statistics);
  void pass(const std::string& name, const std::function<void(Commands&)>& record);
  /// Submits, waits, adds to records() and begins anew; for frames too long for one submission.
  void flush();
  /// Submits, waits and adds to records().
  void end();

  const std::vector<PassRecord>& records() const { return records_; }
  double wall_ms() const { return wall_ms_; }  ///< from submission to fence, summed since clear
  void clear_records();

 private:
  static constexpr std::uint32_t max_passes = 1024;
  void timestamp();
  void collect();
  PassRecord& record_of(const std::string& name);

  Device& device_;
  PipelineCache& cache_;
  Owned<VkCommandPool> pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  Owned<VkFence> fence_;
  Owned<VkQueryPool> timestamps_;
  Owned<VkQueryPool> statistics_;
  std::vector<std::string> names_;
  bool count_statistics_ = false;
  std::vector<PassRecord> records_;
  double wall_ms_ = 0.0;
};

}  // namespace penumbra::vulkan
