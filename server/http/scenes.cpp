#include "scenes/library.h"
#include "server/http/body.h"
#include "server/http/reply.h"
#include "server/http/routes.h"
#include "server/http/scene_upload.h"
#include "server/http/service.h"
#include "server/jobs/catalogue.h"
#include "server/jobs/request_scene.h"

namespace penumbra::server::http {
namespace {

bool is_built_in(const std::string& id) {
  for (const auto& scene : scenes::built_in())
    if (scene.id == id) return true;
  return false;
}

void list_scenes(Call& call) {
  send_json(call.response, 200, scene_catalogue(call.service.folder.path()));
}

void get_scene(Call& call) {
  const auto list = scene_catalogue(call.service.folder.path());
  for (auto scene : list.at("scenes")) {
    if (scene.at("id") != call.path.at("id")) continue;
    const RequestContext context{call.service.folder.path(), call.service.options.device, false};
    scene.update(scene_choices(*load_request_scene(call.path.at("id"), context).scene));
    return send_json(call.response, 200, scene);
  }
  throw nothing_here();
}

void put_scene(Call& call) {
  const auto& id = call.path.at("id");
  check_scene_id(id);
  if (is_built_in(id)) throw Error("conflict", "built-in scenes cannot be replaced", "id");
  const auto& data = call.service.folder.path();
  const auto stopping = [&service = call.service] { return service.draining.load(); };
  const auto about = store_scene(data, id, call.body, [&](const std::filesystem::path& file) {
    return call.service.scene_reader.read(file, stopping);
  });
  const std::string title = about.at("title");
  send_json(call.response, about.at("replaced").get<bool>() ? 200 : 201,
            {{"id", id},
             {"title", title.empty() ? id : title},
             {"description", "imported"},
             {"built_in", false},
             {"notes", about.at("notes")}});
}

void delete_scene(Call& call) {
  const auto& id = call.path.at("id");
  if (is_built_in(id)) throw Error("conflict", "built-in scenes cannot be removed", "id");
  check_scene_id(id);
  if (!remove_scene(call.service.folder.path(), id)) throw nothing_here();
  call.response.status = 204;
}

}  // namespace

void add_scene_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/api/v1/scenes", Access::laboratory, list_scenes});
  table.push_back({"GET", "/api/v1/scenes/{id}", Access::laboratory, get_scene});
  table.push_back({"PUT", "/api/v1/scenes/{id}", Access::researcher, put_scene, largest_upload});
  table.push_back({"DELETE", "/api/v1/scenes/{id}", Access::researcher, delete_scene});
}

}  // namespace penumbra::server::http
