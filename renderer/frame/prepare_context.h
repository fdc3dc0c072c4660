#pragma once

#include <span>

#include "renderer/frame/geometry_buffer.h"
#include "renderer/frame/gpu_scene.h"
#include "renderer/scene/light_points.h"
#include "renderer/scene/transforms.h"
#include "renderer/technique.h"
#include "renderer/vulkan/commands.h"

namespace penumbra {

/// How casters are drawn. The core adds the vertex input, and compiles a second variant with MASKED
/// defined (and surface attributes as input) for materials with holes.
struct CasterProgram {
  std::map<VkShaderStageFlagBits, std::string> stages;
  std::string preamble;
  vulkan::GraphicsState state;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;  ///< of single-sided materials; others are never culled
  /// Whether only the surface nearest to the light counts. Closed bodies that the light is outside
  /// of are then drawn without their faces that are turned away from it.
  bool first_surface_alone = false;
  bool shades_holes_alone = false;  ///< materials without are drawn without a fragment stage
  bool all_surfaces = false;        ///< also those that cast no shadow
  bool cull_by_spheres = false;     ///< around the boxes that are culled by otherwise
};

/// What draw_casters drew.
struct DrawnCasters {
  std::uint64_t triangles = 0;
  std::uint64_t ranges = 0;  ///< of the index buffer: an instance has one for each material
};

/// What a technique may use in `prepare`: the device, the scene, its light, the geometry buffer,
/// and passes that are timed and labelled. Everything created through `memory` is charged to it.
class PrepareContext {
 public:
  const TechniqueInput& input;
  const GpuScene& scene;
  const WorldLight& light;
  const LightFit& fit;
  const CameraMatrices& camera;          ///< of the window that is drawn
  const CameraMatrices& picture_camera;  ///< of the whole picture
  const GeometryBuffer& geometry;
  vulkan::Device& device;
  vulkan::PipelineCache& pipelines;
  vulkan::MemoryLedger& memory;
  vulkan::ConstantArena& constants;  ///< of this batch
  vulkan::Recorder& recorder;
  const vulkan::Bindings&
      frame_bindings;  ///< FrameBlock, LightBlock, LightPointBlock, ParameterBlock,
                       ///< geometry_position, geometry_words, MaterialBlock, FaultBlock
  const std::string& declarations;    ///< GLSL of parameters and definitions, for own programs
  std::span<const glm::vec4> points;  ///< light points of this batch: points_per_batch places for
                                      ///< each sample of a pixel, points_in_batch of them in use
  std::span<const glm::vec4> all_points;  ///< of all batches: as many for each sample of a pixel
  std::uint32_t points_in_batch;
  std::uint32_t batch;
  std::uint32_t batches;  ///< of this light in this frame
  std::uint32_t frame_index;
  std::vector<std::string>& notes;  ///< shown with the result; adding one twice is harmless
  const SceneAdjacency* adjacency;  ///< where Requirements::adjacency asks for it, otherwise null

  /// Records a timed pass. Passes of one name add up in the report.
  void pass(const std::string& name, const std::function<void(vulkan::Commands&)>& record) {
    recorder.pass(name, record);
  }

  /// Draws all casters that may touch the clip volume of `clip_from_world`; inside a rendering.
  /// `bindings` are the program's own resources; those of the frame are added.
  DrawnCasters draw_casters(vulkan::Commands& commands, const CasterProgram& program,
                            const vulkan::Bindings& bindings, const glm::mat4& clip_from_world);
};

}  // namespace penumbra
