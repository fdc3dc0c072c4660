#pragma once

#include <nlohmann/json.hpp>

#include "server/jobs/canonical_request.h"

namespace penumbra::server {

/// What a render would allocate, upload and draw, and why, without a device: the request's scene,
/// technique and parameters; `supported` with `reason`; `lights` with the technique's needs of
/// each; `lines` (renderer/plan/plan.h); and `bytes` of the scene `kept` and `dropped`, and those
/// that the `technique` allocates beside it, as far as they follow from parameters.
nlohmann::json plan_document(const CanonicalRequest& request);

}  // namespace penumbra::server
