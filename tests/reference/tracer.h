#pragma once

#include <embree3/rtcore.h>

#include "renderer/frame/prepare_context.h"
#include "renderer/reference/occlusion_mask.h"

namespace penumbra::tests {

/// A surface point and the unit normal of its facet, rounded as the geometry buffer rounds it.
struct Receiver {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0.0f, 1.0f, 0.0f};
  bool surface = false;
};

/// Embree with the casters of a scene: what is true of rays.
class Embree {
 public:
  explicit Embree(const GpuScene& scene);
  ~Embree();
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  /// What the camera sees, pixel after pixel; normals are towards it. The camera's near plane is
  /// that of the scene's first camera.
  std::vector<Receiver> receivers(const CameraMatrices& camera, std::uint32_t size) const;
  /// Whether a caster stands between the receiver and the point (w of 1), or in the direction (w of
  /// 0), triangles left out whose planes are within `rounding` of it, m. The receiver's own facet
  /// hides what is behind it.
  bool hidden(const Receiver& receiver, float rounding, const glm::vec4& point) const;

 private:
  RTCScene add(const GpuScene& scene, bool casters_only);
  RTCDevice device_;
  RTCScene all_, casters_;
};

/// Runs the pass that is under test on receivers of our own choice.
class Tracer {
 public:
  explicit Tracer(std::shared_ptr<const Scene> scene);

  const GpuScene& scene() const { return *scene_; }
  /// Bit masks of a light's points, batch after batch, in each the receivers row by row. There are
  /// size * size receivers.
  std::vector<std::vector<std::uint32_t>> masks(
      const Light& light, std::span<const Receiver> receivers, std::uint32_t size,
      std::span<const glm::vec4> points,
      std::uint32_t rounds = reference::OcclusionMask::default_rounds);
  std::uint32_t unfinished() const;

 private:
  GeometryBuffer upload_receivers(std::span<const Receiver> receivers, std::uint32_t size);

  vulkan::Device device_;
  vulkan::ShaderLibrary library_;
  vulkan::MemoryLedger ledger_;
  vulkan::PipelineCache pipelines_;
  vulkan::Recorder recorder_;
  vulkan::ConstantArena constants_;
  vulkan::Buffer faults_;
  std::unique_ptr<GpuScene> scene_;
};

}  // namespace penumbra::tests
