#include "renderer/frame/renderer_state.h"

#include <algorithm>

#include "renderer/frame/frame_run.h"

namespace penumbra {

// By the build: the files of shaders, and those that it generates.
std::span<const EmbeddedFile> embedded_renderer_shaders();
std::span<const EmbeddedFile> generated_renderer_shaders();

namespace {

constexpr VkDeviceSize constants_bytes = 16u << 20;

/// The most recently used entry that `matches`, or a new one in place of the oldest.
template <class Entry, class Matches, class Make>
Entry& recent(std::list<Entry>& list, const Matches& matches, const Make& make) {
  constexpr std::size_t kept = 4;
  const auto found = std::find_if(list.begin(), list.end(), matches);
  if (found != list.end()) {
    list.splice(list.begin(), list, found);
  } else {
    if (list.size() == kept) list.pop_back();
    list.push_front(make());
  }
  return list.front();
}

}  // namespace

Renderer::State::State(const RendererOptions& options)
    : device(options),
      pipelines(device, shaders),
      recorder(device, pipelines),
      constants(device, ledger, constants_bytes),
      faults(device, ledger, "fault counter", sizeof(std::uint32_t),
             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, vulkan::MemoryKind::readback),
      most_window_samples(options.most_window_samples) {
  shaders.add(embedded_renderer_shaders());
  shaders.add(generated_renderer_shaders());
}

const std::vector<Bounds>& Renderer::State::boxes_of(const std::shared_ptr<const Scene>& scene) {
  return recent(
             boxes_, [&](const Boxes& entry) { return entry.scene == scene; },
             [&] {
               return Boxes{scene, instance_boxes(*scene)};
             })
      .boxes;
}

const GpuScene& Renderer::State::upload(const std::shared_ptr<const Scene>& scene,
                                        const Camera& camera, const Plan& plan) {
  const SceneFrame frame = scene_frame(*scene, camera);
  return *recent(
      scenes_,
      [&](const auto& entry) { return entry->serves(scene, plan.instances, plan.textures, frame); },
      [&] {
        return std::make_unique<GpuScene>(device, scene, plan.instances, plan.textures, frame);
      });
}

}  // namespace penumbra
