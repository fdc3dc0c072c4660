#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "renderer/render.h"
#include "renderer/scene/scene.h"
#include "techniques/registry.h"

namespace penumbra::server {

/// What a request is read against.
struct RequestContext {
  std::filesystem::path data;  ///< where imported scenes lie; may be empty
  std::string device;          ///< as RendererOptions::device
  bool files = false;  ///< paths are scenes too: for a person's command line, never for HTTP
  std::uint64_t kept_scene_bytes = 256u << 20;  ///< of loaded scenes that are kept for later
};

/// A request with nothing left open.
struct CanonicalRequest {
  nlohmann::json request;  ///< every default filled in; the picture is a pure function of this
  std::string id;          ///< 32 hexadecimal digits of SHA-256 of the request's text
  std::shared_ptr<const Scene> scene;  ///< lights and cameras not yet replaced
  techniques::Resolved technique;

  // Not part of the picture's identity.
  bool measure = false;
  std::uint32_t frames = 0;  ///< frames to time; 0: the measurement chooses
};

/// Timed frames of a measurement that names no number.
inline constexpr std::uint32_t default_frames = 9;

/// Reads a request as POST /api/v1/renders has it: scene, technique, parameters, width, height,
/// camera, camera_path, cameras, supersampling, light_samples, exposure, lights, seed, diagnostic,
/// measure, frames.
/// Throws bad_value, naming the field and what is allowed, for unknown keys, wrong types and values
/// out of range; not_found for scene, technique or camera.
CanonicalRequest read_request(const nlohmann::json& request, const RequestContext& context);

/// The request that is the truth for this one: same scene, camera, size, samples and lights, drawn
/// by the technique of family `truth` with its defaults and the default seed. Parameters common to
/// all techniques (how light is encoded) are carried over.
CanonicalRequest reference_of(const CanonicalRequest& request, const RequestContext& context);

/// The same view without shadows: what a technique's time is compared with.
CanonicalRequest baseline_of(const CanonicalRequest& request);

/// What the renderer draws for a canonical request, light overrides applied.
RenderRequest to_render_request(const CanonicalRequest& request);

/// A request from names and values as text: URL queries, `--set`. Names that are no key of a
/// request are parameters; `light.NAME.key` is an entry of `lights`, `camera.NAME.key` one of
/// `cameras`. A name given twice is a bad value.
nlohmann::json request_from_text(const std::vector<std::pair<std::string, std::string>>& entries);

/// What of a scene a request may change key by key.
enum class Changed { light, camera };

/// Adds `NAME.key=value` to the `lights` or `cameras` of a request. The value is a number, numbers
/// separated by commas, JSON, or a word.
void add_override(nlohmann::json& request, Changed what, const std::string& path,
                  const std::string& value);

}  // namespace penumbra::server
