#pragma once

#include "renderer/frame/frame_targets.h"
#include "renderer/frame/light_pass.h"
#include "renderer/frame/renderer_state.h"

namespace penumbra {

/// The passes of one render, and what they draw into: a window of the picture at a time, with some
/// of the lights' points at a time.
class FrameRun {
 public:
  /// `window`: any of those that the picture is drawn in, since all are of one size. `in_rounds`:
  /// rounds of light points are to be averaged, and read in linear light.
  FrameRun(Renderer::State& state, const RenderRequest& request, const ParameterValues& parameters,
           const Window& window, bool in_rounds);

  /// Moves the camera between frames; what techniques keep from frame to frame stays.
  void look_through(const Camera& camera);
  /// Draws a window with these of a pixel's light points, frame `index`. `progress` gets the share
  /// done of what takes long.
  void draw(const Window& window, PointRange round, std::uint32_t index, bool count_statistics,
            const std::function<void(double)>& progress);
  /// Encodes a mean of rounds, RGBA in linear light with exposure, into the targets' picture.
  void encode(const ImageF& linear);

  const FrameTargets& targets() const { return targets_; }
  const CameraMatrices& picture_camera() const { return setup_.picture_matrices; }
  Uncertainty* uncertainty() const { return targets_.uncertainty.get(); }
  const std::vector<std::unique_ptr<LightPass>>& lights() const { return lights_; }
  std::vector<std::string> notes() const;  ///< sorted, each once
  /// Device memory of the technique, beside what every picture takes.
  std::vector<ResourceCost> technique_memory() const;

 private:
  FrameTargets::Wanted wanted_targets(bool in_rounds) const;
  bool draws_uncertainty() const;  ///< as a diagnostic picture
  /// Whether the errors of all lights are known.
  bool knows_uncertainty() const;
  void check_uncertainty() const;
  /// The first that reaches anything visible, or the number of lights.
  std::size_t first_light() const;
  vulkan::Bindings frame_bindings();
  void draw_lights(const vulkan::Bindings& bindings, std::uint32_t index,
                   const std::function<void(double)>& progress);
  /// Whether the one light there is, if any, writes finished pixels: they have one sample.
  bool light_finishes() const;
  /// What lights are drawn into; the first that is drawn clears their sum.
  LightPass::Output light_output(bool first) const;
  /// Whether anything reads the geometry buffer where no surface is.
  bool reads_sky() const;
  /// The picture as it is stored, and in linear light where that is asked for.
  LightPass::Output picture_output() const;
  LightPass::Output begun_picture() const;  ///< with a sky that is the same everywhere
  void resolve(const vulkan::Bindings& bindings);
  /// A program over some of the picture.
  struct Resolve {
    vulkan::ProgramSource program;
    VkRect2D area;
    VkCompareOp depth;  ///< what the geometry's depth is to be beside infinity's
  };
  VkRect2D whole() const { return {{0, 0}, {setup_.window.width, setup_.window.height}}; }
  /// What is left where the one light has finished what it may reach: sky, and other surfaces.
  std::vector<Resolve> unfinished_parts() const;
  void draw_resolve(const vulkan::Bindings& bindings, const LightPass::Output& output,
                    std::vector<Resolve> parts);
  void resolve_visibility(const vulkan::Bindings& bindings, std::uint32_t light);

  Renderer::State& state_;
  const RenderRequest& request_;
  Plan plan_;
  FrameSetup setup_;
  std::vector<std::unique_ptr<LightPass>> lights_;  ///< null where the plan has left one out
  FrameTargets targets_;
  std::vector<std::string> notes_;
};

}  // namespace penumbra
