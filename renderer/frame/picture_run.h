#pragma once

#include <chrono>

#include "renderer/frame/cost_report.h"
#include "renderer/frame/frame_run.h"
#include "renderer/frame/round_sum.h"

namespace penumbra {

/// Draws a picture to the end: frame by frame where time is measured, each window by window, and
/// each of those round by round of light points. Most pictures are one of each.
class PictureRun {
 public:
  PictureRun(Renderer::State& state, const RenderRequest& request,
             const ParameterValues& parameters, const RenderControl& control);
  RenderResult run();

 private:
  using Clock = std::chrono::steady_clock;

  /// How far a frame has come; all that a picture which is taken up again needs to know.
  struct Progress {
    std::uint32_t window = 0;
    std::uint32_t round = 0;
    std::uint32_t light_samples = 0;  ///< most that a window has drawn
    std::uint64_t non_finite_pixels = 0;
    Image8 picture, diagnostic;
    ImageF linear, visibility, judged, uncertainty, points;
    RoundSum sum;  ///< of the window at hand

    template <class Archive>
    void visit(Archive& archive);
  };

  /// Whether a GPU's clocks are of interest.
  bool tells_clocks() const;
  /// False where they did not rise in time.
  bool wait_for_clocks();
  /// Draws a frame of each camera that goes before the picture's.
  void draw_earlier_cameras();
  void draw_frame(std::uint32_t index);
  void draw_round(const Window& window, std::uint32_t index);
  /// Whether the window at hand needs no further round.
  bool window_is_done() const;
  void finish_window(const Window& window);
  ImageF standard_error(const ImageF& linear) const;
  void read_visibility(ImageF& visibility, ImageF& judged) const;
  /// Copies what the window shows of surfaces into `points`, where frames of the path are followed.
  void read_points(const Window& window, ImageF& points) const;
  bool follows_path() const { return control_.path_frame && request_.visibility; }
  void hand_over(ImageF points, ImageF visibility, ImageF judged) const;
  void report(double share_of_round) const;
  void between_parts();
  std::uint64_t signature() const;
  std::string state();
  void take_up();
  void add_notes(RenderResult& result) const;

  Renderer::State& state_;
  const RenderRequest& request_;
  const ParameterValues& parameters_;
  const RenderControl& control_;
  Clock::time_point start_ = Clock::now();
  std::vector<Window> windows_;
  std::vector<PointRange> rounds_;
  FrameRun frame_;
  bool goes_through_points_ = false;  ///< any light, those of the picture's light_samples
  std::size_t cameras_done_ = 0;      ///< of the request's earlier ones
  std::uint32_t frames_total_ = 1;
  std::uint32_t frame_index_ = 0;
  Progress now_;
  double taken_up_at_ = 0.0;  ///< share of the picture
  CostReport costs_;
  double settling_ms_ = 0.0;
};

}  // namespace penumbra
