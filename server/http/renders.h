#pragma once

#include <httplib.h>

#include <nlohmann/json.hpp>

#include "server/http/routes.h"
#include "server/jobs/render_service.h"

namespace penumbra::server::http {

/// Body of GET /api/v1/renders/{id}.
nlohmann::json body_of(const RenderRecord& record);

/// Who calls, as the render service knows submitters: a lease for this one call, which no other
/// call knows.
Submitter submitter_of(const Call& call);

/// Hands a request to the render service, within the limit per client.
RenderRecord submit(Call& call, const nlohmann::json& request, const Submitter& who);

/// Releases a submission at the end of its block: what was asked for by this call alone is
/// cancelled where the call ends before the picture is drawn.
class Held {
 public:
  Held(RenderService& renders_, std::string id_, Submitter who_)
      : renders(renders_), id(std::move(id_)), who(std::move(who_)) {}
  ~Held() { renders.release(id, who.keys); }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

 private:
  RenderService& renders;
  std::string id;
  Submitter who;
};

/// Waits until the render is over or `seconds` have passed; one of a bounded number who may (busy
/// beyond). A client that hangs up is noticed within a second, and `cancelled` thrown; whether the
/// render goes on is for its submitters to say.
RenderRecord wait_for(Call& call, const RenderRecord& record, double seconds);

/// Sends an artefact, made where the render lacks it, with headers that let everybody keep it for
/// ever; 304 where the client has it.
void send_artefact(Call& call, const RenderRecord& record, const std::string& name);

}  // namespace penumbra::server::http
