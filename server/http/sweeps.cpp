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

/// Sweeps that run side by side, and that are kept; others are asked for anew from the cache.
constexpr std::size_t most_at_once = 4;
constexpr std::size_t most_kept = 32;

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

json body_of_sweep(const SweepState& sweep) {
  const auto self = "/api/v1/sweeps/" + sweep.id;
  return {{"id", sweep.id},
          {"status", sweep.done() ? "done" : "running"},
          {"done", sweep.over - sweep.failed},
          {"failed", sweep.failed},
          {"total", sweep.total},
          {"links",
           {{"self", self}, {"results", self + "/results.csv"}, {"events", self + "/events"}}}};
}

std::string cell(const json& object, const json::json_pointer& place) {
  if (!object.contains(place) || object.at(place).is_null()) return {};
  const auto& value = object.at(place);
  return study::csv_text(value.is_string() ? value.get<std::string>() : value.dump());
}

const std::vector<std::pair<std::string, json::json_pointer>>& columns() {
  static const std::vector<std::pair<std::string, json::json_pointer>> list{
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
      {"frame_difference", "/quality/frame_difference"_json_pointer},
      {"error", "/error/message"_json_pointer},
  };
  return list;
}

std::string header() {
  std::string line;
  for (const auto& [name, place] : columns()) line += (line.empty() ? "" : ",") + name;
  return line + "\r\n";
}

std::string row_of(const json& request, const RenderRecord& record) {
  const json row = {{"request", request},  {"status", record.status},   {"id", record.id},
                    {"cost", record.cost}, {"quality", record.quality}, {"error", record.error}};
  std::string line;
  for (const auto& column : columns()) line += (line.empty() ? "" : ",") + cell(row, column.second);
  return line + "\r\n";
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

void get_sweep_results(Call& call) {
  const auto rows = call.service.sweeps.results(call.path.at("id"));
  if (!rows) throw nothing_here();
  call.response.status = 200;
  call.response.set_content(*rows, "text/csv; charset=utf-8");
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

SweepRequests::SweepRequests(const json& request) {
  check_keys(request, {"scenes", "techniques", "sizes", "measure"});
  measure = request.value("measure", json(true));
  if (!measure.is_boolean()) throw bad_value("measure", "must be true or false");
  scenes = list_of(request, "scenes", 100, nullptr, &json::is_string);
  sizes = list_of(request, "sizes", 20, {600}, &json::is_number_integer);
  techniques = list_of(request, "techniques", 100, nullptr, &json::is_string);
}

json SweepRequests::at(std::size_t row) const {
  const json& size = sizes[row / techniques.size() % sizes.size()];
  return {{"scene", scenes[row / techniques.size() / sizes.size()]},
          {"technique", techniques[row % techniques.size()]},
          {"width", size},
          {"height", size},
          {"measure", measure}};
}

Sweeps::Sweep::Sweep(std::string id, SweepRequests requests_)
    : state{std::move(id), requests_.size(), 0, 0}, requests(std::move(requests_)) {}

SweepState Sweeps::start(const json& request, const std::string& id, const std::string& now) {
  const SweepRequests checked(request);
  stored.put(id, request, now);
  const std::lock_guard lock(mutex);
  return add(id, request)->state;
}

Sweeps::Shared Sweeps::add(const std::string& id, const json& request) {
  if (stopping) throw Error("draining", "the server is stopping");
  forget_old();
  auto sweep = std::make_shared<Sweep>(id, SweepRequests(request));
  sweeps[id] = sweep;
  order.push_back(id);
  waiting.push_back(sweep);
  if (idle < waiting.size() && threads.size() < most_at_once)
    threads.emplace_back([this] { work(); });
  changed.notify_all();
  return sweep;
}

/// Keeps the newest and those that are not done.
void Sweeps::forget_old() {
  for (auto id = order.begin(); id != order.end() && order.size() >= most_kept;) {
    const bool done = sweeps.at(*id)->state.done();
    if (done) sweeps.erase(*id);
    id = done ? order.erase(id) : std::next(id);
  }
}

Sweeps::Shared Sweeps::known(const std::string& id) {
  if (const auto found = sweeps.find(id); found != sweeps.end()) return found->second;
  const auto request = stored.find(id);
  if (!request || stopping) return nullptr;
  return add(id, *request);
}

std::optional<SweepState> Sweeps::find(const std::string& id) {
  const std::lock_guard lock(mutex);
  const Shared sweep = known(id);
  if (!sweep) return std::nullopt;
  return sweep->state;
}

std::optional<SweepState> Sweeps::wait(const std::string& id, std::size_t over, double seconds) {
  std::unique_lock lock(mutex);
  const Shared sweep = known(id);
  if (!sweep) return std::nullopt;
  changed.wait_for(lock, std::chrono::duration<double>(seconds),
                   [&] { return sweep->state.over > over || stopping; });
  return sweep->state;
}

std::optional<std::string> Sweeps::results(const std::string& id) {
  const std::lock_guard lock(mutex);
  const Shared sweep = known(id);
  if (!sweep) return std::nullopt;
  return header() + sweep->rows;
}

json Sweeps::statistics() {
  const std::lock_guard lock(mutex);
  return {{"kept", sweeps.size()}, {"waiting", waiting.size()}, {"running", running}};
}

void Sweeps::work() {
  std::unique_lock lock(mutex);
  while (true) {
    ++idle;
    changed.wait(lock, [&] { return stopping || !waiting.empty(); });
    --idle;
    if (stopping) return;
    const Shared sweep = waiting.front();
    waiting.pop_front();
    ++running;
    lock.unlock();
    render_all(*sweep);
    lock.lock();
    --running;
  }
}

void Sweeps::render_all(Sweep& sweep) {
  const Submitter who{Priority::researcher, "sweep", {"sweep " + sweep.state.id}, {}};
  for (std::size_t i = 0; i < sweep.requests.size() && !stopping; ++i) {
    const json request = sweep.requests.at(i);
    const RenderRecord record = render(request, who);
    if (stopping) return;
    const std::lock_guard lock(mutex);
    if (record.status != "done") ++sweep.state.failed;
    sweep.rows += row_of(request, record);
    ++sweep.state.over;
    changed.notify_all();
  }
}

/// Waits for the render, and for its turn where the queue is full or no worker can be had.
RenderRecord Sweeps::render(const json& request, const Submitter& who) {
  RenderRecord record;
  while (!stopping) {
    try {
      record = renders.submit(request, who);
      while (!stopping && !is_over(record)) {
        const auto later = renders.wait(record.id, 1.0);
        if (!later) break;
        record = *later;
      }
    } catch (...) {
      const Error error = error_of(std::current_exception());
      record.status = "failed";
      record.error = error_body(error).at("error");
    }
    const std::string code = record.status == "failed" ? failure_of(record).code : "";
    if (is_over(record) && code != "busy" && code != "draining") return record;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return record;
}

void Sweeps::stop() {
  std::vector<std::thread> ending;
  {
    const std::lock_guard lock(mutex);
    stopping = true;
    ending.swap(threads);
  }
  changed.notify_all();
  for (std::thread& thread : ending) thread.join();
}

void add_sweep_routes(std::vector<Route>& table) {
  const std::string one = "/api/v1/sweeps/{id}";
  table.push_back({"POST", "/api/v1/sweeps", Access::researcher, post_sweep});
  table.push_back({"GET", one, Access::researcher, get_sweep});
  table.push_back({"GET", one + "/results.csv", Access::researcher, get_sweep_results});
  table.push_back({"GET", one + "/events", Access::researcher, get_sweep_events});
}

}  // namespace penumbra::server::http
