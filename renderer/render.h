#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/image.h"
#include "renderer/parameters.h"
#include "renderer/scene/scene.h"

namespace penumbra {

struct TechniqueDescription;  // renderer/technique.h

/// Ranges of a request; the only place where they stand.
struct RenderLimits {
  static constexpr std::uint32_t max_size = 8192;          ///< pixels, width or height
  static constexpr std::uint32_t max_light_samples = 65536;
  static constexpr std::uint32_t max_frames = 1000;
  static constexpr std::array<std::uint32_t, 3> supersampling{1, 4, 16};  ///< samples per pixel
};

/// Rules that drop what a picture does not need (renderer/scene/plan.h). The picture is the same with
/// and without each; they are here so that what each saves can be measured.
struct PlanRules {
  bool lights = true;    ///< no light that reaches nothing visible
  bool surfaces = true;  ///< no surface that the camera cannot see
  bool casters = true;   ///< no caster that can shadow nothing visible
  bool textures = true;  ///< no texture that nothing drawn reads
};

/// One picture. The result is a pure function of this, the device and the version of the renderer.
struct RenderRequest {
  std::shared_ptr<const Scene> scene;
  std::string camera;  ///< empty: the scene's first
  const TechniqueDescription* technique = nullptr;
  ParameterValues parameters;            ///< of the technique; missing ones take their defaults
  std::uint32_t width = 600;             ///< pixels
  std::uint32_t height = 600;            ///< pixels
  std::uint32_t supersampling = 1;       ///< samples per pixel of the frame: 1, 4 or 16
  std::uint32_t light_samples = 1024;    ///< rays per pixel and light, for techniques that take many
  std::uint64_t seed = 1;
  bool visibility = false;               ///< also return one visibility channel per light
  bool linear = false;                   ///< also return linear light before encoding
  bool uncertainty = false;              ///< also tell the error that finitely many light points leave
  std::string diagnostic;                ///< name of a diagnostic picture of the technique, or empty
  std::uint32_t frames = 1;              ///< counted frames; above 1 one uncounted frame goes first
  PlanRules rules;
};

/// Device time and pipeline statistics of one pass; counts are of one frame.
struct PassCost {
  std::string name;
  double median_ms = 0.0;
  std::uint64_t vertices = 0;             ///< input assembly vertices
  std::uint64_t primitives = 0;           ///< input assembly primitives
  std::uint64_t vertex_invocations = 0;
  std::uint64_t geometry_invocations = 0;
  std::uint64_t geometry_primitives = 0;
  std::uint64_t clipped_primitives = 0;   ///< primitives that leave the clipper
  std::uint64_t fragment_invocations = 0;
  std::uint64_t compute_invocations = 0;
};

struct ResourceCost {
  std::string name;
  std::uint64_t bytes = 0;
};

struct Cost {
  double median_ms = 0.0;  ///< device time of a frame
  double p95_ms = 0.0;
  std::uint32_t frames = 0;
  double wall_median_ms = 0.0;  ///< submission to fence
  double create_ms = 0.0;       ///< pipelines, buffers, uploads and the uncounted frame
  std::vector<PassCost> passes;
  std::vector<ResourceCost> technique_memory;  ///< what the technique asked for over `none`
};

struct RenderResult {
  Image8 picture;                ///< RGBA, sRGB-encoded
  ImageF linear;                 ///< RGB, when asked for
  ImageF visibility;             ///< a channel per light, 1 lit; when asked for
  ImageF judged;                 ///< a channel per light: share of the pixel that faces the light
                                 ///< inside its cone, where visibility means something
  Image8 diagnostic;             ///< RGBA, when asked for
  ImageF uncertainty;            ///< standard error of Y of the encoded picture, 0..255; when asked for
                                 ///< and known, which takes a multiple of 16 points for each sample
  std::optional<double> noise_rms_y;  ///< root mean square of `uncertainty`: what it adds to rms_y
  std::vector<std::string> light_names;
  Cost cost;
  std::uint64_t non_finite_pixels = 0;  ///< encoded as magenta
  std::vector<std::string> notes;
};

struct DeviceInfo {
  std::string name;
  std::string driver;  ///< name and version
  std::string type;    ///< cpu, integrated, discrete, virtual, other
  std::uint32_t index = 0;
};

/// All Vulkan devices of this machine, in the loader's order.
std::vector<DeviceInfo> list_devices();

struct RendererOptions {
  std::string device;       ///< part of a name, or an index; empty: a GPU if there is one, else lavapipe
  bool validation = false;  ///< turn the validation layer on; its messages fail the render
};

/// Draws frames on one device. Not thread-safe; create one per thread.
class Renderer {
 public:
  explicit Renderer(const RendererOptions& options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// `progress` gets values from 0 to 1 during long renders; throwing from it cancels.
  RenderResult render(const RenderRequest& request,
                      const std::function<void(double)>& progress = {});

  const DeviceInfo& device() const;

  struct State;  ///< the implementation's own

 private:
  std::unique_ptr<State> state;
};

/// Changes whenever pictures may: part of every render's identity.
const char* renderer_version();

}  // namespace penumbra
