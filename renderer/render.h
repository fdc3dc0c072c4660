#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/device.h"
#include "renderer/image.h"
#include "renderer/parameters.h"
#include "renderer/path_frame.h"
#include "renderer/scene/scene.h"

namespace penumbra {

struct TechniqueDescription;  // renderer/technique.h

/// Ranges of a request; the only place that has them.
struct RenderLimits {
  static constexpr std::uint32_t max_size = 16384;  ///< pixels, width or height
  static constexpr std::uint32_t max_light_samples = 65536;
  static constexpr std::uint32_t max_frames = 1000;
  static constexpr std::size_t max_camera_path = 1000;                    ///< cameras
  static constexpr double max_error_bound = 255.0;                        ///< levels of 8 bits
  static constexpr double max_exposure = 30.0;                            ///< EV, up or down
  static constexpr std::array<std::uint32_t, 3> supersampling{1, 4, 16};  ///< samples per pixel
};

/// Samples along a side of a pixel; `supersampling` is one of RenderLimits's.
constexpr std::uint32_t samples_per_side(std::uint32_t supersampling) {
  return supersampling == 16 ? 4 : supersampling == 4 ? 2 : 1;
}

/// Rules that drop what a picture does not need (renderer/plan/plan.h). The picture is the same
/// with and without each; they are here so that what each saves can be measured.
struct PlanRules {
  bool lights = true;    ///< no light that reaches nothing visible
  bool surfaces = true;  ///< no surface that the camera cannot see
  bool casters = true;   ///< no caster that can shadow nothing visible
  bool textures = true;  ///< no texture that nothing drawn reads
  /// Maps' depths from the nearest caster that matters to the farthest surface that is seen and
  /// lit, not from end to end of the scene. Unlike the others it may change a picture, to the
  /// better.
  bool depth_range = true;
};

/// The rules that change no picture, by the names that a plan's lines have.
inline constexpr std::pair<const char*, bool PlanRules::*> lossless_rules[] = {
    {"lights", &PlanRules::lights},
    {"surfaces", &PlanRules::surfaces},
    {"casters", &PlanRules::casters},
    {"textures", &PlanRules::textures}};

/// One picture. The result is a pure function of this, the device and the version of the renderer.
struct RenderRequest {
  std::shared_ptr<const Scene> scene;
  std::string camera;  ///< empty: the scene's first
  /// Where the camera was before: a frame of each is drawn first, in order. Techniques that keep
  /// something from frame to frame bring it to the picture.
  std::vector<Camera> earlier_cameras;
  const TechniqueDescription* technique = nullptr;
  ParameterValues parameters;          ///< of the technique; missing ones take their defaults
  std::uint32_t width = 600;           ///< pixels
  std::uint32_t height = 600;          ///< pixels
  std::uint32_t supersampling = 1;     ///< samples per pixel of the frame: 1, 4 or 16
  std::uint32_t light_samples = 1024;  ///< rays per pixel and light, for techniques that take many
  std::uint64_t seed = 1;
  /// Linear light is multiplied by 2^exposure before encoding; EV. Without it: by the scene's
  /// factor.
  std::optional<double> exposure;
  bool visibility = false;  ///< also return one visibility channel per light
  bool linear = false;      ///< also return linear light before encoding
  /// Light points are drawn round by round until `noise_rms_y` is no more than this, or
  /// light_samples of them are; 0: all of them.
  double error_bound = 0.0;
  bool uncertainty = false;  ///< also tell the error that finitely many light points leave
  std::string diagnostic;    ///< name of a diagnostic picture of the technique, or empty
  std::uint32_t frames = 1;  ///< counted frames; above 1 one uncounted frame goes first
  /// Counted frames wait until a GPU's clocks are up, and it is told if they fell meanwhile.
  bool settle = false;
  PlanRules rules;
};

/// Factor from linear light to what is encoded.
float exposure_factor(const RenderRequest& request);

/// Device time and pipeline statistics of one pass; counts are of one frame.
struct PassCost {
  std::string name;
  double median_ms = 0.0;
  std::uint64_t vertices = 0;    ///< input assembly vertices
  std::uint64_t primitives = 0;  ///< input assembly primitives
  std::uint64_t vertex_invocations = 0;
  std::uint64_t geometry_invocations = 0;
  std::uint64_t geometry_primitives = 0;
  std::uint64_t clipped_primitives = 0;  ///< primitives that leave the clipper
  std::uint64_t fragment_invocations = 0;
  std::uint64_t compute_invocations = 0;
};

struct Cost {
  double median_ms = 0.0;  ///< device time of a frame
  double p95_ms = 0.0;
  double spread = 0.0;  ///< half the distance between quartiles, as a share of the median
  std::uint32_t frames = 0;
  bool settled = true;          ///< false where `settle` was asked for and clocks were not up
  double wall_median_ms = 0.0;  ///< submission to fence
  double timing_ms = 0.0;       ///< wall time of all counted frames
  double settling_ms = 0.0;     ///< and until a GPU's clocks were up, before them
  double create_ms = 0.0;       ///< pipelines, buffers, uploads and the uncounted frame
  std::vector<PassCost> passes;
  std::vector<ResourceCost> technique_memory;  ///< what the technique asked for over `none`
};

struct RenderResult {
  Image8 picture;      ///< RGBA, sRGB-encoded
  ImageF linear;       ///< RGB, when asked for
  ImageF visibility;   ///< a channel per light, 1 lit; when asked for
  ImageF judged;       ///< a channel per light: share of the pixel that faces the light
                       ///< inside its cone, where visibility means something
  Image8 diagnostic;   ///< RGBA, when asked for
  ImageF uncertainty;  ///< standard error of Y of the encoded picture, 0..255; when asked for
                       ///< and known, which takes a multiple of 16 points for each sample
  std::optional<double> noise_rms_y;  ///< root mean square of `uncertainty`: what it adds to rms_y
  std::uint32_t light_samples = 0;  ///< drawn in each pixel: all, or fewer where the bound was met
  std::vector<std::string> light_names;
  Cost cost;
  std::uint64_t non_finite_pixels = 0;  ///< encoded as magenta
  std::vector<std::string> notes;
};

/// How a long render is followed, and taken up again where it was interrupted.
struct RenderControl {
  std::function<void(double)> progress;  ///< gets values from 0 to 1; throwing from it cancels
  /// Called between the parts of a picture that is drawn in several (see Renderer). `state` makes
  /// bytes from which the same request, on the same device, goes on after that part.
  std::function<void(const std::function<std::string()>& state)> between_parts;
  std::string resume;  ///< such bytes. Others are ignored, and the picture begins anew.
  /// Gets each frame of the camera's path, the picture's own last; where the request asks for
  /// visibility. Those before it are drawn with the first round of light points.
  std::function<void(PathFrame)> path_frame;
};

/// Draws frames on one device. A picture with very many samples is drawn window by window, one with
/// very many light points, or with an error bound, round by round of its points. Not thread-safe;
/// create one per thread.
class Renderer {
 public:
  explicit Renderer(const RendererOptions& options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  RenderResult render(const RenderRequest& request, const RenderControl& control = {});

  const DeviceInfo& device() const;
  DeviceLimits limits() const;

  struct State;  ///< the implementation's own

 private:
  std::unique_ptr<State> state;
};

/// Changes whenever pictures may: part of every render's identity.
const char* renderer_version();

}  // namespace penumbra
