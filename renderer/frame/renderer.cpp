#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/error.h"
#include "renderer/frame/common_parameters.h"
#include "renderer/frame/picture_run.h"

namespace penumbra {

const char* renderer_version() {
  return "0.1.0";
}

float exposure_factor(const RenderRequest& request) {
  return request.exposure ? static_cast<float>(std::exp2(*request.exposure))
                          : request.scene->exposure;
}

namespace {

void check_request(const RenderRequest& request) {
  if (!request.scene || request.technique == nullptr)
    throw std::logic_error("a render needs a scene and a technique");
  const std::uint32_t largest = std::max(request.width, request.height);
  if (std::min(request.width, request.height) == 0 || largest > RenderLimits::max_size)
    throw bad_value("width",
                    "width and height must be 1 to " + std::to_string(RenderLimits::max_size));
  const auto& allowed = RenderLimits::supersampling;
  if (std::find(allowed.begin(), allowed.end(), request.supersampling) == allowed.end())
    throw bad_value("supersampling", "supersampling must be 1, 4 or 16");
  if (request.light_samples == 0 || request.light_samples > RenderLimits::max_light_samples)
    throw bad_value("light_samples", "light_samples must be 1 to " +
                                         std::to_string(RenderLimits::max_light_samples));
  if (!(request.error_bound >= 0.0 && request.error_bound <= RenderLimits::max_error_bound))
    throw bad_value("error_bound", "error_bound must be 0 to 255 levels");
  if (request.exposure && !(std::abs(*request.exposure) <= RenderLimits::max_exposure))
    throw bad_value("exposure", "exposure must be -30 to 30 EV");
  if (request.frames == 0 || request.frames > RenderLimits::max_frames)
    throw bad_value("frames", "frames must be 1 to " + std::to_string(RenderLimits::max_frames));
  // The last of a path is the picture's own camera.
  if (request.earlier_cameras.size() >= RenderLimits::max_camera_path)
    throw bad_value("camera_path", "camera_path must hold no more than " +
                                       std::to_string(RenderLimits::max_camera_path) + " cameras");
  for (std::size_t i = 0; i < request.earlier_cameras.size(); ++i)
    validate_camera(request.earlier_cameras[i], "camera_path[" + std::to_string(i) + "]");
}

}  // namespace

Renderer::Renderer(const RendererOptions& options) : state(std::make_unique<State>(options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const DeviceInfo& Renderer::device() const {
  return state->device.info;
}

DeviceLimits Renderer::limits() const {
  return state->device.limits();
}

RenderResult Renderer::render(const RenderRequest& request, const RenderControl& control) {
  check_request(request);
  validate(*request.scene);
  find_diagnostic(*request.technique, request.diagnostic);  // throws for a name that is not known
  const ParameterValues parameters =
      complete_parameters(request.technique->parameters, request.parameters);
  state->shaders.add(request.technique->files);
  state->pipelines.trim();
  return PictureRun(*state, request, parameters, control).run();
}

}  // namespace penumbra
