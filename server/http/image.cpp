// GET /api/v1/image and /api/v1/plan: a request in the query.
#include "renderer/error.h"
#include "renderer/technique.h"
#include "server/http/renders.h"
#include "server/http/reply.h"
#include "server/http/service.h"
#include "server/jobs/canonical_request.h"

namespace penumbra::server::http {
namespace {

nlohmann::json request_in_query(const Call& call) {
  std::vector<std::pair<std::string, std::string>> entries(call.request.params.begin(),
                                                           call.request.params.end());
  return request_from_text(entries);
}

void get_image(Call& call) {
  auto record = submit(call, request_in_query(call));
  if (!is_over(record)) record = wait_for(call, record, call.service.options.render_deadline_s);
  if (!is_over(record)) throw Error("deadline", "the picture was not ready in time");
  send_artefact(call, record, "image.png");
}

nlohmann::json light_plan(const RenderRequest& request, const Light& light, const Camera& camera) {
  const TechniqueInput input{*request.scene,        light,         camera,
                             request.parameters,    request.width, request.height,
                             request.light_samples, request.seed};
  Requirements needs;
  std::string reason;
  try {
    request.technique->create()->require(input, needs);
  } catch (const Error& error) {
    if (error.code != "unsupported") throw;
    reason = error.what();
  }
  return {{"light", light.name},
          {"supported", reason.empty()},
          {"reason", reason},
          {"stencil", needs.stencil},
          {"adjacency", needs.adjacency},
          {"acceleration_structure", needs.acceleration_structure},
          {"light_points", needs.light_points},
          {"shade_each_point", needs.shade_each_point},
          {"random_points", needs.random_points}};
}

void get_plan(Call& call) {
  const RequestContext context{call.service.folder.path(), call.service.options.device, false};
  const auto canonical = read_request(request_in_query(call), context);
  const auto request = to_render_request(canonical);
  const auto& camera = request.scene->cameras.at(find_camera(*request.scene, request.camera));
  auto lights = nlohmann::json::array();
  for (const auto& light : request.scene->lights)
    lights.push_back(light_plan(request, light, camera));
  send_json(call.response, 200,
            {{"scene", canonical.request.at("scene")},
             {"technique", canonical.request.at("technique")},
             {"parameters", canonical.request.at("parameters")},
             {"lights", lights}});
}

}  // namespace

void add_image_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/api/v1/image", Access::anyone, get_image});
  table.push_back({"GET", "/api/v1/plan", Access::anyone, get_plan});
}

}  // namespace penumbra::server::http
