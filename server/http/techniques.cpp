#include "server/http/reply.h"
#include "server/http/routes.h"
#include "server/jobs/catalogue.h"

namespace penumbra::server::http {
namespace {

void list_techniques(Call& call) {
  send_json(call.response, 200, technique_catalogue());
}

}  // namespace

void add_technique_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/api/v1/techniques", Access::laboratory, list_techniques});
}

}  // namespace penumbra::server::http
