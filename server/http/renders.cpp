#include "server/http/renders.h"

#include <algorithm>
#include <chrono>

#include "server/http/body.h"
#include "server/http/event_stream.h"
#include "server/http/reply.h"
#include "server/http/request_stream.h"
#include "server/http/secrets.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

constexpr double longest_wait_s = 60.0;

std::string path_of(const RenderRecord& record) {
  return "/api/v1/renders/" + record.id;
}

RenderRecord record_at(Call& call) {
  const auto record = call.service.renders->find(call.path.at("id"));
  if (!record) throw nothing_here();
  return *record;
}

/// Keys cannot be mistaken for one another: what a client names is a lease, whatever it says.
std::string lease_key(const std::string& lease) {
  return "lease " + lease;
}
constexpr auto researcher_key = "researcher";

/// The connection of a call is its client's own, unless a proxy is between.
std::optional<std::string> connection_key(const Call& call) {
  if (behind_proxy(call.request)) return {};
  return "connection " + call.request.remote_addr + " " + std::to_string(call.request.remote_port);
}

/// Counts a render against the limit of its client.
void check_allowance(Call& call) {
  if (call.service.draining) throw Error("draining", "the server is stopping");
  if (behind_proxy(call.request) && !is_researcher(call.service, call.request) &&
      !call.service.render_calls.allow(client_of(call.request)))
    throw Error("too_many", "too many renders from one address; wait a little");
}

void post_render(Call& call) {
  const std::string lease = random_token();
  Submitter who = submitter_of(call);
  who.keys = {lease_key(lease)};
  if (const auto key = connection_key(call)) who.keys.insert(*key);
  who.further_keys = {researcher_key};
  const auto record = submit(call, call.json(), who);
  call.response.set_header("Location", path_of(record));
  auto body = body_of(record);
  body["lease"] = lease;
  if (!is_over(record)) body["links"]["cancel"] = path_of(record) + "?lease=" + lease;
  send_json(call.response, is_over(record) ? 200 : 202, body);
}

void get_render(Call& call) {
  const double seconds = number_in_query(call.request, "wait_s", 0.0, longest_wait_s, 0.0);
  auto record = record_at(call);
  if (seconds > 0.0 && !is_over(record)) record = wait_for(call, record, seconds);
  send_json(call.response, 200, body_of(record));
}

void cancel_render(Call& call) {
  const auto before = record_at(call);
  std::set<std::string> keys{lease_key(call.request.get_param_value("lease"))};
  if (const auto key = connection_key(call)) keys.insert(*key);
  if (is_researcher(call.service, call.request)) keys.insert(researcher_key);
  if (!call.service.renders->release(before.id, keys) && !is_over(record_at(call)))
    throw Error("forbidden",
                "others asked for this render; only a lease, given when it was posted, cancels it",
                "lease");
  // A running one ends within milliseconds.
  const auto after = call.service.renders->wait(before.id, 0.0);
  send_json(call.response, 200, body_of(after ? *after : before));
}

template <const char* name>
void get_artefact(Call& call) {
  send_artefact(call, record_at(call), name);
}

void get_events(Call& call) {
  auto seen = std::make_shared<RenderRecord>(record_at(call));
  auto first = std::make_shared<bool>(true);
  send_events(call, [seen, first, &service = call.service](EventSink& sink) {
    if (!*first) {
      const auto next = service.renders->wait_change(seen->id, *seen, 1.0);
      if (!next) return false;
      const bool same = next->status == seen->status && next->progress == seen->progress;
      if (same) return sink.keep_alive() && !service.draining;
      *seen = *next;
    }
    *first = false;
    return sink.send("render", body_of(*seen)) && !is_over(*seen);
  });
}

constexpr char picture[] = "image.png";
constexpr char linear[] = "image.exr";
constexpr char visibility[] = "visibility.exr";
constexpr char difference[] = "error.png";

std::string artefact_type(const std::string& name) {
  return name.ends_with(".png") ? "image/png" : "image/x-exr";
}

/// Has a finished render's file made that is not stored, or damaged; null where it has none.
SharedBytes make_artefact(Call& call, const std::string& id, const std::string& name) {
  check_allowance(call);
  const Submitter who = submitter_of(call);
  const auto asked = call.service.renders->submit_artefact(id, name, who);
  if (!asked) return nullptr;
  const Held held(*call.service.renders, id, who);
  const auto made = wait_for(call, *asked, call.service.options.render_deadline_s);
  if (!is_over(made)) throw Error("deadline", "the file was not ready in time");
  if (made.status != "done") throw failure_of(made);
  return call.service.renders->stored_artefact(id, name);
}

}  // namespace

nlohmann::json body_of(const RenderRecord& record) {
  const auto self = path_of(record);
  nlohmann::json links = {{"self", self}, {"events", self + "/events"}};
  if (record.status == "done") {
    links["image"] = self + "/" + picture;
    links["linear"] = self + "/" + linear;
    links["visibility"] = self + "/" + visibility;
    links["error"] = self + "/" + difference;
  }
  return {{"id", record.id},
          {"status", record.status},
          {"progress", record.progress},
          {"request", record.request},
          {"device", record.device},
          {"error", record.error},
          {"cost", record.cost},
          {"quality", record.quality},
          {"notes", record.notes},
          {"links", links}};
}

Submitter submitter_of(const Call& call) {
  const bool researcher = is_researcher(call.service, call.request);
  Submitter who;
  who.priority = researcher ? Priority::researcher : Priority::anonymous;
  who.client = researcher ? researcher_key : client_of(call.request);
  who.keys = {lease_key(random_token())};
  return who;
}

RenderRecord submit(Call& call, const nlohmann::json& request, const Submitter& who) {
  check_allowance(call);
  return call.service.renders->submit(request, who);
}

RenderRecord wait_for(Call& call, const RenderRecord& record, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  const auto place = call.service.waits.take();
  const auto& connection = RequestStream::current();
  RenderRecord seen = record;
  while (!is_over(seen)) {
    const double left = std::chrono::duration<double>(end - Clock::now()).count();
    if (left <= 0.0) break;
    const auto next = call.service.renders->wait(record.id, std::min(left, 1.0));
    if (!next) throw nothing_here();
    seen = *next;
    if (!is_over(seen) && !call.service.draining && connection.closed_by_peer())
      throw Error("cancelled", "the client hung up");
  }
  return seen;
}

void send_artefact(Call& call, const RenderRecord& record, const std::string& name) {
  if (record.status == "failed") throw failure_of(record);
  if (record.status != "done") throw Error("conflict", "the render is " + record.status, "status");
  // The artefacts of one render have addresses of their own, so that its id serves as tag for each.
  auto& response = call.response;
  // What needs a token belongs into no cache that others are served from.
  const std::string whose = is_local(call.service.options) ? "public" : "private";
  response.set_header("Cache-Control", whose + ", max-age=31536000, immutable");
  if (client_has(call.request, response, record.id)) return;
  SharedBytes bytes;
  try {
    bytes = call.service.renders->stored_artefact(record.id, name);
    if (!bytes) bytes = make_artefact(call, record.id, name);
    if (!bytes) throw nothing_here();
  } catch (...) {
    response.headers.erase("ETag");
    response.headers.erase("Cache-Control");
    throw;
  }
  response.status = 200;
  // All that send it share one copy.
  response.set_content_provider(
      bytes->size(), artefact_type(name),
      [bytes](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(bytes->data() + offset, length);
      });
}

void add_render_routes(std::vector<Route>& table) {
  const std::string one = "/api/v1/renders/{id}";
  table.push_back({"POST", "/api/v1/renders", Access::laboratory, post_render, 256 << 10});
  table.push_back({"GET", one, Access::laboratory, get_render});
  table.push_back({"DELETE", one, Access::laboratory, cancel_render});
  table.push_back({"GET", one + "/image.png", Access::laboratory, get_artefact<picture>});
  table.push_back({"GET", one + "/image.exr", Access::laboratory, get_artefact<linear>});
  table.push_back({"GET", one + "/visibility.exr", Access::laboratory, get_artefact<visibility>});
  table.push_back({"GET", one + "/error.png", Access::laboratory, get_artefact<difference>});
  table.push_back({"GET", one + "/events", Access::laboratory, get_events});
}

}  // namespace penumbra::server::http
