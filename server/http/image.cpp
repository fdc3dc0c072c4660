// GET /api/v1/image and /api/v1/plan: a request in the query.
#include "renderer/error.h"
#include "server/http/renders.h"
#include "server/http/reply.h"
#include "server/http/service.h"
#include "server/jobs/plan_document.h"

namespace penumbra::server::http {
namespace {

nlohmann::json request_in_query(const Call& call) {
  std::vector<std::pair<std::string, std::string>> entries(call.request.params.begin(),
                                                           call.request.params.end());
  return request_from_text(entries);
}

void get_image(Call& call) {
  const Submitter who = submitter_of(call);
  auto record = submit(call, request_in_query(call), who);
  const Held held(*call.service.renders, record.id, who);
  if (!is_over(record)) record = wait_for(call, record, call.service.options.render_deadline_s);
  if (!is_over(record)) throw Error("deadline", "the picture was not ready in time");
  send_artefact(call, record, "image.png");
}

void get_plan(Call& call) {
  const RequestContext context{call.service.folder.path(), call.service.options.device, false};
  send_json(call.response, 200, plan_document(read_request(request_in_query(call), context)));
}

}  // namespace

void add_image_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/api/v1/image", Access::laboratory, get_image});
  table.push_back({"GET", "/api/v1/plan", Access::laboratory, get_plan});
}

}  // namespace penumbra::server::http
