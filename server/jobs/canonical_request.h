#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

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

/// Reads a request as POST /api/v1/renders has it (requests/fields.h).
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

}  // namespace penumbra::server
