#pragma once

#include <list>

#include "renderer/frame/gpu_scene.h"
#include "renderer/frame/yardstick.h"
#include "renderer/render.h"
#include "renderer/vulkan/commands.h"

namespace penumbra {

/// What a device keeps between renders: compiled pipelines and the last scenes.
struct Renderer::State {
  explicit State(const RendererOptions& options);

  const std::vector<Bounds>& boxes_of(const std::shared_ptr<const Scene>& scene);
  const GpuScene& upload(const std::shared_ptr<const Scene>& scene, const Camera& camera,
                         const Plan& plan);

  vulkan::Device device;
  vulkan::ShaderLibrary shaders;
  vulkan::MemoryLedger ledger;
  vulkan::PipelineCache pipelines;
  vulkan::Recorder recorder;
  vulkan::ConstantArena constants;
  vulkan::Buffer faults;
  std::uint64_t most_window_samples;  ///< as RendererOptions
  Yardstick yardstick;

 private:
  struct Boxes {
    std::shared_ptr<const Scene> scene;
    std::vector<Bounds> boxes;
  };
  std::list<Boxes> boxes_;  ///< most recently used first, and so are the scenes
  std::list<std::unique_ptr<GpuScene>> scenes_;
};

}  // namespace penumbra
