// What callers see: requests in, records and files out. The workers' side is in draw_jobs.cpp.
#include "server/jobs/queued_render_service.h"

#include <algorithm>
#include <csignal>

#include "renderer/error.h"
#include "server/jobs/deadline.h"
#include "server/jobs/memory_budget.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr std::size_t remembered_failures = 1024;

/// Submitters of one render that are told apart; it is drawn for the others in any case.
constexpr std::size_t most_submitters = 1000;

/// How long a first request waits for the first worker to tell what its device can hold, seconds.
constexpr double device_patience_s = 10.0;

Error busy(const std::string& message) {
  return {"busy", message};
}

bool share_one(const std::set<std::string>& a, const std::set<std::string>& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& key) { return b.contains(key); });
}

WorkerCommand command_of(const RenderServiceOptions& options) {
  WorkerCommand command;
  command.arguments = options.worker_command;
  if (command.arguments.empty()) command.arguments = {"/proc/self/exe", "worker"};
  command.arguments.insert(command.arguments.end(), {"--data", options.data.string()});
  if (!options.device.empty())
    command.arguments.insert(command.arguments.end(), {"--device", options.device});
  command.arguments.insert(command.arguments.end(),
                           {"--memory-limit", std::to_string(worker_memory(options.workers))});
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

void QueuedRenderService::check(const json& request) {
  read_request(request, context_);
}

RenderRecord QueuedRenderService::submit(const json& request, const Submitter& who) {
  CanonicalRequest canonical = read_request(request, context_);
  std::set<std::string> wants{want::image};
  if (canonical.measure) wants.insert({want::cost, want::quality, want::error_map});
  return enqueue(std::move(canonical), wants, who);
}

std::shared_ptr<Job> QueuedRenderService::job_of(const std::string& id) {
  const auto found = jobs_.find(id);
  return found == jobs_.end() ? nullptr : found->second;
}

/// Throws for what would not be drawn: there is no worker, the device cannot hold it, or it ended
/// two workers.
void QueuedRenderService::check_admissible(const CanonicalRequest& request,
                                           const std::set<std::string>& wants) {
  if (const std::string why = crew_.trouble(); !why.empty()) throw busy(why);
  {
    const Lock lock(mutex_);
    if (deaths_.refuses(request.id))
      throw unsupported(
          "this picture ended the renderer twice; it is refused until the server is "
          "started again");
  }
  check_fits(request, wants, crew_.limits(device_patience_s));
  if (const std::string why = crew_.trouble(); !why.empty()) throw busy(why);
}

RenderRecord QueuedRenderService::enqueue(CanonicalRequest request,
                                          const std::set<std::string>& wants,
                                          const Submitter& who) {
  const std::set<std::string> lacking = missing(request.id, wants, request.frames);
  const auto known = stored(request.id);
  const bool drawn = lacking.empty() && known;
  const auto in_flight = [&] {
    const Lock lock(mutex_);
    return jobs_.contains(request.id);
  };
  if (!drawn && !in_flight()) check_admissible(request, wants);

  const Lock lock(mutex_);
  if (const auto job = job_of(request.id)) {
    ++counters_["shared"];
    job->wants.insert(wants.begin(), wants.end());
    if (request.frames > 0) job->request.frames = request.frames;
    if (job->record.status == "queued") job->alone = job->wants.contains(want::cost);
    join(*job, who);
    return job->record;
  }
  if (drawn) {
    ++counters_["cache_hits"];
    over_.erase(request.id);  // an old failure to measure it no longer counts
    return *known;
  }
  if (draining_) throw busy("the server is shutting down");
  if (queue_.waiting(who.priority) >= options_.queue_limit)
    throw busy("the queue is full (" + std::to_string(options_.queue_limit) + " renders wait)");

  ++counters_["cache_misses"];
  auto job = std::make_shared<Job>();
  if (known) job->record = *known;
  job->record.id = request.id;
  job->record.status = "queued";
  job->record.progress = 0.0;
  job->record.request = request.request;
  job->wants = wants;
  job->alone = wants.contains(want::cost);
  job->submitters = {who};
  job->priority = who.priority;
  job->client = who.client;
  job->request = std::move(request);
  job->request.scene.reset();  // a worker reads its own; hundreds may wait
  jobs_[job->record.id] = job;
  over_.erase(job->record.id);
  queue_.push(job);
  changed_.notify_all();
  return job->record;
}

/// Adds a submitter, and moves what waits to the turn of one that comes before the others.
void QueuedRenderService::join(Job& job, const Submitter& who) {
  const bool known =
      std::any_of(job.submitters.begin(), job.submitters.end(),
                  [&](const Submitter& each) { return share_one(who.keys, each.keys); });
  if (!known && job.submitters.size() < most_submitters) job.submitters.push_back(who);
  job.cancelled = stopping_;  // it may have been released by all others a moment ago
  if (who.priority <= job.priority) return;
  const bool waits = queue_.remove(job);
  job.priority = who.priority;
  job.client = who.client;
  if (waits) queue_.push(jobs_.at(job.record.id));
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

std::optional<RenderRecord> QueuedRenderService::find(const std::string& id) {
  {
    const Lock lock(mutex_);
    if (const auto job = job_of(id)) return job->record;
    if (const auto over = over_.find(id); over != over_.end()) return over->second;
  }
  return stored(id);  // reads the disk
}

std::optional<RenderRecord> QueuedRenderService::wait(const std::string& id, double seconds) {
  {
    Lock lock(mutex_);
    if (const auto job = job_of(id)) {
      job->ended.wait_until(lock, after(seconds), [&] { return job->over; });
      return job->record;
    }
  }
  return find(id);
}

std::optional<RenderRecord> QueuedRenderService::wait_change(const std::string& id,
                                                             const RenderRecord& seen,
                                                             double seconds) {
  {
    Lock lock(mutex_);
    if (const auto job = job_of(id)) {
      job->moved.wait_until(lock, after(seconds), [&] {
        return job->over || job->record.status != seen.status ||
               job->record.progress != seen.progress;
      });
      return job->record;
    }
  }
  return find(id);
}

bool QueuedRenderService::release(const std::string& id, const std::set<std::string>& keys) {
  const Lock lock(mutex_);
  const auto job = job_of(id);
  if (!job) return false;
  const auto released = std::erase_if(job->submitters, [&](const Submitter& each) {
    return share_one(keys, each.keys) || share_one(keys, each.further_keys);
  });
  if (released == 0 || !job->submitters.empty()) return released > 0;
  job->cancelled = true;  // where it runs, its thread sees this within milliseconds
  if (queue_.remove(*job)) {
    job->record.status = "cancelled";
    ++counters_["cancelled"];
    remember(job->record);
    end(*job);
  }
  return true;
}

/// The job is done with, whatever became of it.
void QueuedRenderService::end(Job& job) {
  job.over = true;
  job.moved.notify_all();
  job.ended.notify_all();
  changed_.notify_all();
  jobs_.erase(std::string(job.record.id));
}

SharedBytes QueuedRenderService::stored_artefact(const std::string& id, const std::string& name) {
  const auto& names = artefact_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) return nullptr;
  SharedBytes bytes = store_.read(id, name);
  if (!bytes) return nullptr;
  const Lock lock(mutex_);
  ++counters_["cache_hits"];
  return bytes;
}

std::optional<RenderRecord> QueuedRenderService::submit_artefact(const std::string& id,
                                                                 const std::string& name,
                                                                 const Submitter& who) {
  const auto& names = artefact_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) return {};
  const auto known = find(id);
  if (!known || known->status == "failed" || known->status == "cancelled") return {};
  json request = known->request;
  if (name == want::error_map && request.at("diagnostic") != "") return {};
  for (const char* derived : {"renderer", "scene_hash", "device"}) request.erase(derived);
  CanonicalRequest canonical = read_request(request, context_);
  if (canonical.id != id) return {};  // scene or renderer changed since: that picture is history
  return enqueue(std::move(canonical), {name}, who);
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
  all["trouble"] = crew_.trouble();
  all["cache_renders"] = cache.renders;
  all["cache_records_loaded"] = cache.loaded;
  all["cache_bytes"] = cache.bytes;
  all["cache_bytes_limit"] = options_.cache_bytes;
  all["cache_damaged"] = cache.damaged;
  all["cache_evicted"] = cache.evicted;
  all["cache_write_failures"] = cache.write_failures;
  const Lock lock(mutex_);
  all["workers"] = threads_.size();
  all["queued"] = queue_.waiting();
  all["queued_publication"] = queue_.waiting(Priority::publication);
  all["queued_researcher"] = queue_.waiting(Priority::researcher);
  all["queued_anonymous"] = queue_.waiting(Priority::anonymous);
  all["refused_pictures"] = deaths_.refused();
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
    ++counters_["failed"];
    remember(job->record);
    end(*job);
  }
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
  const Lock lock(mutex_);
  end_waiting(busy("the server is shutting down"));  // what a worker died at, and went back
}

std::unique_ptr<RenderService> make_render_service(const RenderServiceOptions& options) {
  return std::make_unique<QueuedRenderService>(options);
}

}  // namespace penumbra::server
