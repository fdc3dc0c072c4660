#include <map>

#include "scenes/json_text.h"
#include "server/http/clock.h"
#include "server/http/event_stream.h"
#include "server/http/reply.h"
#include "server/http/routes.h"
#include "server/http/secrets.h"
#include "server/http/service.h"
#include "server/http/studies.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

json body_of_experiment(const ExperimentState& state) {
  const std::string self = "/api/v1/experiments/" + state.id;
  return {{"id", state.id},
          {"kind", state.kind},
          {"created_at", state.created_at},
          {"status", state.status},
          {"request", state.request},
          {"progress", state.progress},
          {"error", state.error},
          {"links",
           {{"self", self},
            {"results", self + "/results.csv"},
            {"report", self + "/report.html"},
            {"events", self + "/events"}}}};
}

ExperimentState experiment_at(Call& call) {
  const auto state = call.service.experiments.find(call.path.at("id"));
  if (!state) throw nothing_here();
  return *state;
}

/// What a study showed, by picture: a technique or preset with the parameters given to it, as
/// ID[:NAME=VALUE]... Pictures that were uploaded are left out.
std::map<std::string, std::string> techniques_shown(const study::Study& study) {
  std::map<std::string, std::string> shown;
  for (const study::Page& page : study.pages)
    for (const study::Picture& picture : page.pictures) {
      if (!picture.own.empty()) continue;
      std::string name = picture.technique;
      for (const auto& [key, value] : picture.parameters.items())
        name += ":" + key + "=" +
                (value.is_string() ? value.get<std::string>() : scenes::json_text(value));
      shown.try_emplace(picture.id, name);
    }
  return shown;
}

/// The mean ranks alone, by what was shown: nothing of persons is kept beside an experiment.
json ranks_of(const json& part, const std::map<std::string, std::string>& shown) {
  json rows = json::array();
  for (const json& row : part.at("techniques"))
    if (const auto name = shown.find(row.at("technique")); name != shown.end())
      rows.push_back(
          {{"technique", name->second}, {"weighted_mean_rank", row.at("weighted_mean_rank")}});
  return {{"techniques", rows}};
}

/// The ranks of the study that the request names, shaped as its results.json; empty where it names
/// none.
std::string results_for(Service& service, const json& request) {
  const auto study = study_of_experiment(request);
  if (!study) return {};
  const auto record = service.studies.latest_published(*study);
  if (!record) throw bad_value("study", "there is no published study '" + *study + "'");
  const auto frozen = service.frozen.of(*record);
  const auto shown = techniques_shown(frozen->study);
  auto exported = export_of(service, frozen);
  const json& all = exported.results().at("included_sets").at("all");
  json scenes_of = json::array();
  for (const json& part : all.at("scenes")) {
    scenes_of.push_back(ranks_of(part, shown));
    scenes_of.back()["scene"] = part.at("scene");
  }
  return scenes::json_text(
      json{{"included_sets",
            {{"all", {{"overall", ranks_of(all.at("overall"), shown)}, {"scenes", scenes_of}}}}}});
}

void post_experiment(Call& call) {
  const json request = call.json();
  const auto state = call.service.experiments.start(request, results_for(call.service, request),
                                                    random_uuid(), utc_now());
  call.response.set_header("Location", "/api/v1/experiments/" + state.id);
  send_json(call.response, 202, body_of_experiment(state));
}

void get_experiments(Call& call) {
  json list = json::array();
  for (const auto& state : call.service.experiments.list())
    list.push_back(body_of_experiment(state));
  send_json(call.response, 200, {{"experiments", list}, {"kinds", experiment_kinds()}});
}

void get_experiment(Call& call) {
  send_json(call.response, 200, body_of_experiment(experiment_at(call)));
}

void delete_experiment(Call& call) {
  if (!call.service.experiments.cancel(call.path.at("id"))) throw nothing_here();
  call.response.status = 204;
}

void send_file(Call& call, const std::string& name, const char* type) {
  const auto bytes = call.service.experiments.file(call.path.at("id"), name);
  if (!bytes) throw nothing_here();
  call.response.status = 200;
  call.response.set_content(*bytes, type);
}

void get_experiment_results(Call& call) {
  send_file(call, "results.csv", "text/csv; charset=utf-8");
}

void get_experiment_report(Call& call) {
  // Its script sorts tables. In a sandbox it runs as a stranger: no session, no interface.
  call.response.set_header("Content-Security-Policy",
                           "sandbox allow-scripts; default-src 'none'; style-src 'unsafe-inline'; "
                           "script-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
                           "form-action 'none'; frame-ancestors 'none'");
  send_file(call, "report.html", "text/html; charset=utf-8");
}

void get_experiment_figure(Call& call) {
  send_file(call, "figures/" + call.path.at("figure"), "image/svg+xml");
}

void get_experiment_events(Call& call) {
  auto seen = std::make_shared<ExperimentState>(experiment_at(call));
  auto first = std::make_shared<bool>(true);
  send_events(call, [seen, first, &service = call.service](EventSink& sink) {
    if (!*first) {
      const auto next = service.experiments.wait_change(seen->id, *seen, 1.0);
      if (!next) return false;
      if (next->status == seen->status && next->progress == seen->progress)
        return sink.keep_alive() && !service.draining;
      *seen = *next;
    }
    *first = false;
    return sink.send("experiment", body_of_experiment(*seen)) && !seen->over();
  });
}

}  // namespace

void add_experiment_routes(std::vector<Route>& table) {
  const std::string all = "/api/v1/experiments", one = all + "/{id}";
  table.push_back({"POST", all, Access::researcher, post_experiment});
  table.push_back({"GET", all, Access::researcher, get_experiments});
  table.push_back({"GET", one, Access::researcher, get_experiment});
  table.push_back({"DELETE", one, Access::researcher, delete_experiment});
  table.push_back({"GET", one + "/results.csv", Access::researcher, get_experiment_results});
  table.push_back({"GET", one + "/report.html", Access::researcher, get_experiment_report});
  table.push_back({"GET", one + "/figures/{figure}", Access::researcher, get_experiment_figure});
  table.push_back({"GET", one + "/events", Access::researcher, get_experiment_events});
}

}  // namespace penumbra::server::http
