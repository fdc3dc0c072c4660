#include "server/http/sweeps.h"

#include <algorithm>
#include <chrono>

#include "server/http/body.h"
#include "server/http/clock.h"
#include "server/http/event_stream.h"
#include "server/http/reply.h"
#include "server/http/secrets.h"
#include "server/http/service.h"
#include "study/responses.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

std::vector<json> list_of(const json& request, const char* key, std::size_t most,
                          const json& otherwise, bool (json::*is_right)() const noexcept) {
  const json list = request.value(key, otherwise);
  if (!list.is_array() || list.empty() || list.size() > most)
    throw bad_value(key, "must be a list of 1 to " + std::to_string(most));
  for (std::size_t i = 0; i < list.size(); ++i)
    if (!(list[i].*is_right)())
      throw bad_value(std::string(key) + "[" + std::to_string(i) + "]", "has the wrong type");
  return list.get<std::vector<json>>();
}

/// Every combination as a render request, techniques varying fastest.
std::vector<json> combinations(const json& request) {
  check_keys(request, {"scenes", "techniques", "sizes", "measure"});
  const json measure = request.value("measure", json(true));
  if (!measure.is_boolean()) throw bad_value("measure", "must be true or false");
  std::vector<json> all;
  for (const auto& scene : list_of(request, "scenes", 100, nullptr, &json::is_string))
    for (const auto& size : list_of(request, "sizes", 20, {600}, &json::is_number_integer))
      for (const auto& technique : list_of(request, "techniques", 100, nullptr, &json::is_string))
        all.push_back({{"scene", scene},
                       {"technique", technique},
                       {"width", size},
                       {"height", size},
                       {"measure", measure}});
  return all;
}

json body_of_sweep(const SweepState& sweep) {
  const auto self = "/api/v1/sweeps/" + sweep.id;
  return {{"id", sweep.id},
          {"status", sweep.done() ? "done" : "running"},
          {"done", sweep.over - sweep.failed},
          {"failed", sweep.failed},
          {"total", sweep.requests.size()},
          {"links",
           {{"self", self}, {"results", self + "/results.csv"}, {"events", self + "/events"}}}};
}

std::string cell(const json& object, const json::json_pointer& place) {
  if (!object.contains(place) || object.at(place).is_null()) return {};
  const auto& value = object.at(place);
  return study::csv_text(value.is_string() ? value.get<std::string>() : value.dump());
}

std::string csv_of(const SweepState& sweep) {
  static const std::vector<std::pair<std::string, json::json_pointer>> columns{
      {"scene", "/request/scene"_json_pointer},
      {"technique", "/request/technique"_json_pointer},
      {"size", "/request/width"_json_pointer},
      {"status", "/status"_json_pointer},
      {"render", "/id"_json_pointer},
      {"frame_ms_median", "/cost/frame_ms/median"_json_pointer},
      {"frame_ms_p95", "/cost/frame_ms/p95"_json_pointer},
      {"frame_ms_none_median", "/cost/frame_ms/none_median"_json_pointer},
      {"frame_ms_over_none", "/cost/frame_ms/over_none"_json_pointer},
      {"settled", "/cost/frame_ms/settled"_json_pointer},
      {"create_ms", "/cost/create_ms"_json_pointer},
      {"memory_over_none_bytes", "/cost/memory/over_none_bytes"_json_pointer},
      {"rms_y", "/quality/rms_y"_json_pointer},
      {"psnr", "/quality/psnr"_json_pointer},
      {"ssim", "/quality/ssim"_json_pointer},
      {"flip", "/quality/flip"_json_pointer},
      {"visibility_rms", "/quality/visibility_rms"_json_pointer},
      {"visibility_bias", "/quality/visibility_bias"_json_pointer},
      {"false_shadow", "/quality/false_shadow"_json_pointer},
      {"missing_shadow", "/quality/missing_shadow"_json_pointer},
      {"error", "/error/message"_json_pointer},
  };
  std::string text;
  for (const auto& [name, place] : columns) text += (text.empty() ? "" : ",") + name;
  text += "\r\n";
  for (std::size_t i = 0; i < sweep.records.size(); ++i) {
    if (!sweep.records[i]) continue;
    const auto& record = *sweep.records[i];
    const json row = {
        {"request", sweep.requests[i]}, {"status", record.status},   {"id", record.id},
        {"cost", record.cost},          {"quality", record.quality}, {"error", record.error}};
    std::string line;
    for (std::size_t c = 0; c < columns.size(); ++c)
      line += (c == 0 ? "" : ",") + cell(row, columns[c].second);
    text += line + "\r\n";
  }
  return text;
}

SweepState sweep_at(Call& call) {
  const auto sweep = call.service.sweeps.find(call.path.at("id"));
  if (!sweep) throw nothing_here();
  return *sweep;
}

void post_sweep(Call& call) {
  const auto sweep = call.service.sweeps.start(call.json(), random_uuid(), utc_now());
  call.response.set_header("Location", "/api/v1/sweeps/" + sweep.id);
  send_json(call.response, 202, body_of_sweep(sweep));
}

void get_sweep(Call& call) {
  send_json(call.response, 200, body_of_sweep(sweep_at(call)));
}

void get_results(Call& call) {
  call.response.status = 200;
  call.response.set_content(csv_of(sweep_at(call)), "text/csv; charset=utf-8");
}

void get_sweep_events(Call& call) {
  auto seen = std::make_shared<SweepState>(sweep_at(call));
  auto first = std::make_shared<bool>(true);
  send_events(call, [seen, first, &service = call.service](EventSink& sink) {
    if (!*first) {
      const auto next = service.sweeps.wait(seen->id, seen->over, 1.0);
      if (!next) return false;
      if (next->over == seen->over) return sink.keep_alive() && !service.draining;
      *seen = *next;
    }
    *first = false;
    return sink.send("sweep", body_of_sweep(*seen)) && !seen->done();
  });
}

}  // namespace

SweepState Sweeps::start(const json& request, const std::string& id, const std::string& now) {
  const auto all = combinations(request);
  stored.put(id, request, now);
  const std::lock_guard lock(mutex);
  return run(id, request).state;
}

Sweeps::Running& Sweeps::run(const std::string& id, const json& request) {
  auto running = std::make_unique<Running>();
  running->state.id = id;
  running->state.requests = combinations(request);
  running->state.records.resize(running->state.requests.size());
  auto& reference = *running;
  sweeps[id] = std::move(running);
  reference.thread = std::thread([this, &reference] { render_all(reference); });
  return reference;
}

Sweeps::Running* Sweeps::known(const std::string& id) {
  if (const auto found = sweeps.find(id); found != sweeps.end()) return found->second.get();
  const auto request = stored.find(id);
  if (!request || stopping) return nullptr;
  return &run(id, *request);
}

std::optional<SweepState> Sweeps::find(const std::string& id) {
  const std::lock_guard lock(mutex);
  const auto* running = known(id);
  if (running == nullptr) return std::nullopt;
  return running->state;
}

std::optional<SweepState> Sweeps::wait(const std::string& id, std::size_t over, double seconds) {
  std::unique_lock lock(mutex);
  const auto* running = known(id);
  if (running == nullptr) return std::nullopt;
  changed.wait_for(lock, std::chrono::duration<double>(seconds),
                   [&] { return running->state.over > over || stopping; });
  return running->state;
}

void Sweeps::render_all(Running& running) {
  const std::size_t count = running.state.requests.size();  // requests never change
  for (std::size_t i = 0; i < count && !stopping;) {
    RenderRecord record;
    try {
      record = renders.submit(running.state.requests[i]);
      while (!stopping && (record.status == "queued" || record.status == "running"))
        if (const auto later = renders.wait(record.id, 1.0)) record = *later;
    } catch (...) {
      const Error error = error_of(std::current_exception());
      if (error.code == "draining") return;
      if (error.code == "busy") {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        continue;
      }
      record.status = "failed";
      record.error = error_body(error).at("error");
    }
    if (stopping) return;
    const std::lock_guard lock(mutex);
    if (record.status != "done") ++running.state.failed;
    running.state.records[i] = record;
    ++running.state.over;
    ++i;
    changed.notify_all();
  }
}

void Sweeps::stop() {
  stopping = true;
  changed.notify_all();
  for (auto& [id, running] : sweeps)
    if (running->thread.joinable()) running->thread.join();
}

void add_sweep_routes(std::vector<Route>& table) {
  const std::string one = "/api/v1/sweeps/{id}";
  table.push_back({"POST", "/api/v1/sweeps", Access::researcher, post_sweep});
  table.push_back({"GET", one, Access::researcher, get_sweep});
  table.push_back({"GET", one + "/results.csv", Access::researcher, get_results});
  table.push_back({"GET", one + "/events", Access::researcher, get_sweep_events});
}

}  // namespace penumbra::server::http
