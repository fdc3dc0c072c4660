// What callers see: requests in, records and files out. The workers' side is in draw_jobs.cpp.
#include "server/jobs/queued_render_service.h"

#include <algorithm>
#include <csignal>

#include "renderer/error.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr std::size_t remembered_failures = 1024;

Error busy(const std::string& message) {
  return {"busy", message};
}

bool is_over(const RenderRecord& record) {
  return record.status != "queued" && record.status != "running";
}

steady_clock::time_point after(double seconds) {
  // A day is as good as for ever, and does not overflow.
  const std::chrono::duration<double> wait(std::clamp(seconds, 0.0, 86400.0));
  return steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(wait);
}

WorkerCommand command_of(const RenderServiceOptions& options) {
  WorkerCommand command;
  command.arguments = options.worker_command;
  if (command.arguments.empty()) command.arguments = {"/proc/self/exe", "worker"};
  command.arguments.insert(command.arguments.end(), {"--data", options.data.string()});
  if (!options.device.empty())
    command.arguments.insert(command.arguments.end(), {"--device", options.device});
  command.arguments.insert(command.arguments.end(),
                           {"--checkpoint-s", std::to_string(options.checkpoint_s)});
  if (options.validation) command.arguments.emplace_back("--validation");
  command.driver_cache = options.data / "driver";
  std::filesystem::create_directories(command.driver_cache);
  return command;
}

}  // namespace

QueuedRenderService::QueuedRenderService(const RenderServiceOptions& options)
    : options_(options),
      context_{options.data, options.device, false},
      store_(options.data / "artefacts", options.cache_bytes),
      crew_(command_of(options)) {
  // Writing to a worker that died is an error to handle, and so is a disk that is full.
  sweep_checkpoints(checkpoint_folder(options_.data));
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (unsigned i = 0; i < std::max(1u, options.workers); ++i)
    threads_.emplace_back([this] { work(); });
}

QueuedRenderService::~QueuedRenderService() {
  drain(0.0);
}

std::set<std::string> QueuedRenderService::missing(const std::string& id,
                                                   const std::set<std::string>& wants,
                                                   std::uint32_t frames) {
  const json record = store_.find(id);
  if (record.is_null()) return wants;
  // Pictures of another device are no longer what would be drawn.
  const json device = crew_.device();
  if (!device.is_null() && record.at("device") != device) {
    store_.forget(id);
    return wants;
  }
  std::set<std::string> lacking;
  for (const std::string& name : wants) {
    bool there = false;
    if (name == want::cost) {
      const json& cost = record.at("cost");
      there = !cost.is_null() && (frames == 0 || cost.at("frame_ms").at("frames") == frames);
    } else if (name == want::quality) {
      there = !record.at("quality").is_null();
    } else if (name == want::noise) {
      there = record.contains("noise_rms_y");
    } else {
      there = store_.has(id, name);
    }
    if (!there) lacking.insert(name);
  }
  return lacking;
}

RenderRecord QueuedRenderService::submit(const json& request) {
  CanonicalRequest canonical = read_request(request, context_);
  std::set<std::string> wants{want::image};
  if (canonical.measure) wants.insert({want::cost, want::quality, want::error_map});
  return enqueue(std::move(canonical), wants);
}

RenderRecord QueuedRenderService::enqueue(CanonicalRequest request,
                                          const std::set<std::string>& wants) {
  const std::set<std::string> lacking = missing(request.id, wants, request.frames);
  const auto known = stored(request.id);

  const Lock lock(mutex_);
  if (const auto found = jobs_.find(request.id); found != jobs_.end()) {
    Job& job = *found->second;
    ++job.interest;
    ++counters_["shared"];
    job.wants.insert(wants.begin(), wants.end());
    if (request.frames > 0) job.request.frames = request.frames;
    if (job.record.status == "queued") job.alone = job.wants.contains(want::cost);
    return job.record;
  }
  if (lacking.empty() && known) {
    ++counters_["cache_hits"];
    over_.erase(request.id);  // an old failure to measure it is no longer what stands there
    return *known;
  }
  if (draining_) throw busy("the server is shutting down");
  if (queue_.waiting() >= options_.queue_limit)
    throw busy("the queue is full (" + std::to_string(options_.queue_limit) + " renders wait)");
  if (const std::string trouble = crew_.trouble(); !trouble.empty()) throw busy(trouble);

  ++counters_["cache_misses"];
  auto job = std::make_shared<Job>();
  if (known) job->record = *known;
  job->record.id = request.id;
  job->record.status = "queued";
  job->record.progress = 0.0;
  job->record.request = request.request;
  job->wants = wants;
  job->alone = wants.contains(want::cost);
  job->interest = 1;
  job->request = std::move(request);
  jobs_[job->record.id] = job;
  over_.erase(job->record.id);
  queue_.push(job);
  changed_.notify_all();
  return job->record;
}

std::optional<RenderRecord> QueuedRenderService::stored(const std::string& id) {
  const json record = store_.find(id);
  if (record.is_null()) return {};
  RenderRecord found;
  found.id = id;
  found.status = "done";
  found.progress = 1.0;
  found.request = record.at("request");
  found.device = record.at("device");
  found.cost = record.at("cost");
  found.quality = record.at("quality");
  found.notes = record.at("notes").get<std::vector<std::string>>();
  return found;
}

std::optional<RenderRecord> QueuedRenderService::find_locked(const std::string& id) {
  if (const auto job = jobs_.find(id); job != jobs_.end()) return job->second->record;
  if (const auto over = over_.find(id); over != over_.end()) return over->second;
  return stored(id);
}

std::optional<RenderRecord> QueuedRenderService::find(const std::string& id) {
  const Lock lock(mutex_);
  return find_locked(id);
}

std::optional<RenderRecord> QueuedRenderService::wait(const std::string& id, double seconds) {
  const auto deadline = after(seconds);
  Lock lock(mutex_);
  while (true) {
    auto record = find_locked(id);
    if (!record || is_over(*record)) return record;
    if (changed_.wait_until(lock, deadline) == std::cv_status::timeout) return find_locked(id);
  }
}

std::optional<RenderRecord> QueuedRenderService::wait_change(const std::string& id,
                                                             const RenderRecord& seen,
                                                             double seconds) {
  const auto deadline = after(seconds);
  Lock lock(mutex_);
  while (true) {
    auto record = find_locked(id);
    if (!record || record->status != seen.status || record->progress != seen.progress)
      return record;
    if (changed_.wait_until(lock, deadline) == std::cv_status::timeout) return find_locked(id);
  }
}

bool QueuedRenderService::cancel(const std::string& id) {
  const Lock lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return find_locked(id).has_value();
  const std::shared_ptr<Job> job = found->second;
  if (job->interest > 0) --job->interest;
  if (job->interest > 0) return true;
  job->cancelled = true;  // where it runs, its thread sees this within milliseconds
  if (queue_.remove(*job)) {
    job->record.status = "cancelled";
    remember(job->record);
    jobs_.erase(id);
    ++counters_["cancelled"];
  }
  changed_.notify_all();
  return true;
}

std::optional<std::string> QueuedRenderService::artefact(const std::string& id,
                                                         const std::string& name) {
  const auto& names = artefact_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) return {};
  if (const auto bytes = store_.read(id, name)) {
    const Lock lock(mutex_);
    ++counters_["cache_hits"];
    return *bytes;
  }

  // The render is known but this file of it is not there, or was damaged: have it made.
  const auto known = find(id);
  if (!known || known->status == "failed" || known->status == "cancelled") return {};
  json request = known->request;
  if (name == want::error_map && request.at("diagnostic") != "") return {};
  for (const char* derived : {"renderer", "scene_hash", "device"}) request.erase(derived);
  CanonicalRequest canonical = read_request(request, context_);
  if (canonical.id != id) return {};  // scene or renderer changed since: that picture is history
  enqueue(std::move(canonical), {name});
  const auto made = wait(id, options_.deadline_s * 2.0);
  if (!made) return {};
  if (!made->error.is_null())
    throw Error(made->error.value("code", "internal"), made->error.value("message", ""),
                made->error.value("field", ""));
  const auto bytes = store_.read(id, name);
  if (!bytes) return {};
  return *bytes;
}

void QueuedRenderService::remember(const RenderRecord& record) {
  if (!over_.contains(record.id)) over_order_.push_back(record.id);
  over_[record.id] = record;
  while (over_order_.size() > remembered_failures) {
    over_.erase(over_order_.front());
    over_order_.pop_front();
  }
}

json QueuedRenderService::statistics() {
  json all = crew_.statistics();
  const ArtefactStore::Statistics cache = store_.statistics();
  all["cache_renders"] = cache.renders;
  all["cache_bytes"] = cache.bytes;
  all["cache_bytes_limit"] = options_.cache_bytes;
  all["cache_damaged"] = cache.damaged;
  all["cache_evicted"] = cache.evicted;
  all["cache_write_failures"] = cache.write_failures;
  const Lock lock(mutex_);
  all["workers"] = threads_.size();
  all["queued"] = queue_.waiting();
  all["queue_limit"] = options_.queue_limit;
  all["running"] = queue_.running();
  all["draining"] = draining_;
  for (const char* name : {"cache_hits", "cache_misses", "shared", "rendered", "failed",
                           "cancelled", "deadlines", "retries"})
    all[name] = counters_[name];
  return all;
}

void QueuedRenderService::end_waiting(const Error& error) {
  for (const auto& job : queue_.take_all()) {
    job->record.status = "failed";
    job->record.error = {{"code", error.code}, {"message", error.what()}, {"field", error.field}};
    remember(job->record);
    jobs_.erase(job->record.id);
    ++counters_["failed"];
  }
  changed_.notify_all();
}

void QueuedRenderService::drain(double deadline_s) {
  {
    Lock lock(mutex_);
    draining_ = true;
    end_waiting(busy("the server is shutting down"));
    changed_.wait_until(lock, after(deadline_s), [this] { return queue_.running() == 0; });
    stopping_ = true;
    for (const auto& [id, job] : jobs_) job->cancelled = true;
    changed_.notify_all();
  }
  crew_.stop();
  for (std::thread& thread : threads_)
    if (thread.joinable()) thread.join();
}

std::unique_ptr<RenderService> make_render_service(const RenderServiceOptions& options) {
  return std::make_unique<QueuedRenderService>(options);
}

}  // namespace penumbra::server
