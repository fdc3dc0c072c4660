#pragma once

#include <httplib.h>

#include <nlohmann/json.hpp>

#include "server/http/routes.h"
#include "server/jobs/render_service.h"

namespace penumbra::server::http {

/// Body of GET /api/v1/renders/{id}.
nlohmann::json body_of(const RenderRecord& record);

inline bool is_over(const RenderRecord& record) {
  return record.status != "queued" && record.status != "running";
}

/// Hands a request to the render service, within the limit per client.
RenderRecord submit(Call& call, const nlohmann::json& request);

/// Waits until the render is over or `seconds` have passed; one of a bounded number who may (busy
/// beyond). A client that hangs up is noticed
/// within a second; the render is then cancelled unless others wait for it.
RenderRecord wait_for(Call& call, const RenderRecord& record, double seconds);

/// Sends an artefact with headers that let everybody keep it for ever; 304 for who has it.
void send_artefact(Call& call, const RenderRecord& record, const std::string& name);

}  // namespace penumbra::server::http
