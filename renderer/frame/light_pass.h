#pragma once

#include <memory>

#include "renderer/frame/prepare_context.h"
#include "renderer/frame/uncertainty.h"
#include "renderer/frame/window.h"
#include "renderer/render.h"

namespace penumbra {

/// Everything that stays the same over the frames of one render.
struct FrameSetup {
  const RenderRequest& request;
  const ParameterValues& parameters;  ///< complete
  const GpuScene& scene;
  Camera camera;
  CameraMatrices picture_matrices;
  CameraMatrices matrices;
  std::uint32_t side = 1;    ///< samples along a pixel's side
  Window window;             ///< what of the picture is drawn; `matrices` are its own
  std::string declarations;  ///< GLSL of the parameters

  std::uint32_t width() const { return window.width * side; }  ///< samples of the frame
  std::uint32_t height() const { return window.height * side; }
};

/// One light of a render: its technique's instance and everything that is drawn for it.
class LightPass {
 public:
  /// Creates the technique's instance and asks what it requires; throws `unsupported`. `fit`
  /// outlives this.
  LightPass(const FrameSetup& setup, const Bounds& scene_box, const Light& light,
            const LightFit& fit);

  const Requirements& needs() const { return needs_; }
  /// Whether its error is known: it is exact, or its points come in scrambles.
  bool tells_error() const { return needs_.light_points <= 1 || has_scrambles_; }
  const std::vector<ResourceCost>& memory() const { return ledger_.entries; }

  /// What a light's pass is drawn into, and the definitions that say so to its shader.
  struct Output {
    std::vector<VkFormat> formats;
    std::vector<vulkan::ColorTarget> colors;
    vulkan::Blend blend = vulkan::Blend::off;
    std::string definitions;
  };

  struct Frame {
    vulkan::Device& device;
    vulkan::PipelineCache& pipelines;
    vulkan::ShaderLibrary& shaders;
    vulkan::Recorder& recorder;
    vulkan::ConstantArena& constants;
    const GeometryBuffer& geometry;
    Output output;
    const vulkan::Image* light_sum;  ///< sums over light points, where a light has many
    Uncertainty* uncertainty;        ///< or null
    vulkan::Bindings frame_bindings;
    std::uint32_t frame_index;
    std::vector<std::string>& notes;
  };
  /// The samples that it may reach.
  VkRect2D lit_part() const;
  /// Chooses the points that draw() goes through, of those that a pixel has; a light that has no
  /// more than one point, or another number than the picture, goes through all its own each time.
  void choose_points(PointRange round);
  /// Prepares and shades all batches of the light points. `after_batch` is called with the share
  /// done.
  void draw(const Frame& frame, const std::function<void(double)>& after_batch);
  /// Draws a diagnostic picture into `target` (RGBA8, samples of the frame), after draw.
  void draw_diagnostic(const Frame& frame, const std::string& name, const vulkan::Image& target);

 private:
  void clear_sum(const Frame& frame);
  /// Points of a batch, one set after the other.
  struct Batch {
    std::vector<glm::vec4> points;
    std::uint32_t count;  ///< points of a set in use
    float weight;         ///< of a point
  };
  Batch make_batch(const std::vector<glm::vec4>& points, std::uint32_t index) const;
  void shade_points(const Frame& frame, const vulkan::Bindings& bindings, const Batch& batch,
                    bool at_fully_lit);
  void add_sum(const Frame& frame, const vulkan::Bindings& bindings);
  void shade(const Frame& frame, const vulkan::Bindings& bindings);
  void draw_light(const Frame& frame, const std::string& fragment_stage,
                  const std::string& definitions,
                  const std::function<vulkan::Bindings(const vulkan::Pipeline&)>& bindings_of);
  vulkan::Bindings shading_bindings(const Frame& frame, const vulkan::Bindings& light_bindings,
                                    const vulkan::Pipeline& pipeline) const;
  std::string program_path(vulkan::ShaderLibrary& shaders, const std::string& head) const;

  const FrameSetup& setup_;
  WorldLight light_;
  TechniqueInput input_;
  Requirements needs_;
  std::unique_ptr<Technique> technique_;
  std::string declarations_;  ///< GLSL of the parameters, and what the technique defines
  const LightFit& fit_;
  PointRange round_;                   ///< of the points of a pixel
  std::vector<glm::vec4> points_;      ///< its points, set after set
  std::vector<glm::vec4> few_points_;  ///< for samples that nothing hides the light from
  bool has_scrambles_ = false;
  std::uint32_t sets_ = 1;  ///< samples of a pixel, each with its own points
  vulkan::MemoryLedger ledger_;
  vulkan::Bindings last_bindings_;
};

}  // namespace penumbra
