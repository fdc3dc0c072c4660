// GET /api/v1/image and /api/v1/plan: a request in the query.
#include <chrono>
#include <semaphore>

#include "renderer/error.h"
#include "requests/reader.h"
#include "server/http/renders.h"
#include "server/http/reply.h"
#include "server/http/service.h"
#include "server/jobs/plan_document.h"

namespace penumbra::server::http {
namespace {

nlohmann::json request_in_query(const Call& call) {
  std::vector<std::pair<std::string, std::string>> entries(call.request.params.begin(),
                                                           call.request.params.end());
  return requests::request_from_text(entries);
}

void get_image(Call& call) {
  const Submitter who = submitter_of(call);
  auto record = submit(call, request_in_query(call), who);
  const Held held(*call.service.renders, record.id, who);
  if (!is_over(record)) record = wait_for(call, record, call.service.options.render_deadline_s);
  if (!is_over(record)) throw Error("deadline", "the picture was not ready in time");
  send_artefact(call, record, "image.png");
}

/// Plans of large scenes take seconds and hundreds of megabytes: few are made at once.
constexpr int most_plans = 2;
constexpr auto plan_patience = std::chrono::seconds(20);

void get_plan(Call& call) {
  static std::counting_semaphore<most_plans> places{most_plans};
  if (!places.try_acquire_for(plan_patience)) throw Error("busy", "other plans are being made");
  struct Place {
    ~Place() { places.release(); }
  } const place;
  const RequestContext context{call.service.folder.path(), call.service.options.device, false};
  send_json(call.response, 200, plan_document(read_request(request_in_query(call), context)));
}

}  // namespace

void add_image_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/api/v1/image", Access::laboratory, get_image});
  table.push_back({"GET", "/api/v1/plan", Access::laboratory, get_plan});
}

}  // namespace penumbra::server::http
