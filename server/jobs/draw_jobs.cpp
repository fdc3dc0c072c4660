// The workers' side of the render service: a thread per worker takes jobs and sees them through.
#include "renderer/error.h"
#include "server/jobs/queued_render_service.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

/// Share of a measurement's bar that the reference takes where it must be drawn first.
constexpr double reference_part = 0.6;

/// How often a thread without work looks whether its worker still lives.
constexpr auto between_looks = std::chrono::seconds(1);

Message task_message(const CanonicalRequest& request, const std::set<std::string>& wants) {
  Message message;
  message.body["task"] = {{"request", request.request},
                          {"id", request.id},
                          {"wants", wants},
                          {"frames", request.frames}};
  return message;
}

}  // namespace

void QueuedRenderService::work() {
  Crewman worker;
  constexpr auto never = steady_clock::time_point::max();
  auto last_drawn = never;  // by this worker
  const std::chrono::duration<double> longest_rest(options_.fresh_after_s);
  Lock lock(mutex_);
  while (!stopping_) {
    // A worker is ready before there is work: the first picture need not wait for the driver.
    if (!worker || !worker->alive()) {
      worker.reset();
      last_drawn = never;
      worker = hire(lock);
      continue;  // hiring let go of the lock: the end may have come meanwhile
    }
    // One that died while it had nothing to do must not be blamed on the next picture.
    if (const auto why = worker->died_idle()) {
      crew_.ended();
      crew_.failed(*why);
      continue;
    }
    std::shared_ptr<Job> job = queue_.take();
    if (!job && steady_clock::now() - last_drawn > longest_rest) {
      crew_.ended();
      worker.reset();
      continue;
    }
    if (!job) {
      changed_.wait_for(lock, between_looks);
      continue;
    }
    lock.unlock();
    execute(job, worker);
    lock.lock();
    last_drawn = steady_clock::now();
  }
  lock.unlock();
  if (worker && worker->alive()) crew_.ended();
}

QueuedRenderService::Crewman QueuedRenderService::hire(Lock& lock) {
  // What waits learns at once that nothing is drawn for a while, not when the breaker closes.
  const auto tell = [&] {
    if (const std::string trouble = crew_.trouble(); !trouble.empty())
      end_waiting({"busy", trouble});
  };
  tell();
  lock.unlock();
  Crewman worker = crew_.start();
  lock.lock();
  if (!worker) tell();
  return worker;
}

void QueuedRenderService::execute(const std::shared_ptr<Job>& job, Crewman& worker) {
  std::set<std::string> wants;
  {
    const Lock lock(mutex_);
    job->record.status = "running";
    job->record.device = worker->device();
    wants = job->wants;
    job->moved.notify_all();
  }
  try {
    draw(*job, missing(job->request.id, wants, job->request.frames), worker);
    finish(job, wants, "done", nullptr);
  } catch (const WorkCancelled&) {
    finish(job, wants, "cancelled", nullptr);
  } catch (const WorkerLost& lost) {
    try_again(job, lost.what());
  } catch (const Error& error) {
    finish(job, wants, "failed",
           {{"code", error.code}, {"message", error.what()}, {"field", error.field}});
  } catch (const std::exception& error) {
    finish(job, wants, "failed", {{"code", "internal"}, {"message", error.what()}, {"field", ""}});
  }
}

/// A worker died at the job: it goes back to the front of its line once, and is refused from then
/// on. No job waits for a new worker; its thread gets one before it takes another.
void QueuedRenderService::try_again(const std::shared_ptr<Job>& job, const std::string& why) {
  bool again = false;
  {
    const Lock lock(mutex_);
    again = deaths_.add(job->task) < DeathList::most_deaths && !job->cancelled && !stopping_;
    if (again) {
      ++counters_["retries"];
      queue_.finished(*job);
      job->record.status = "queued";
      job->record.progress = 0.0;
      queue_.push_front(job);
      job->moved.notify_all();
      changed_.notify_all();
    }
  }
  if (again) return;
  const Error error = device_error("the renderer failed twice at this picture: " + why);
  finish(job, {}, job->cancelled ? "cancelled" : "failed",
         {{"code", error.code}, {"message", error.what()}, {"field", ""}});
}

void QueuedRenderService::draw(Job& job, const std::set<std::string>& wants, Crewman& worker) {
  if (wants.empty()) return;  // another has drawn it meanwhile
  double from = 0.0;
  Message task = task_message(job.request, wants);
  if (needs_reference(wants)) {
    ReferencePictures reference = reference_for(job, worker);
    task.body["reference"] = {{"id", reference.id}, {"noise_rms_y", reference.noise_rms_y}};
    task.blobs = {{want::image, std::move(reference.image)},
                  {want::visibility, std::move(reference.visibility)}};
    from = reference_part;
  }
  const Message result = run(job, task, worker, from, 1.0);
  keep(job.request, worker->device(), result);
}

ReferencePictures QueuedRenderService::reference_for(Job& job, Crewman& worker) {
  const CanonicalRequest request = reference_of(job.request, context_);
  const std::set<std::string> wants{want::image, want::visibility, want::noise};
  // The first look may find damaged files; the second then draws them anew.
  for (int look = 0; look < 2; ++look) {
    if (const auto lacking = missing(request.id, wants, 0); !lacking.empty())
      keep(request, worker->device(),
           run(job, task_message(request, lacking), worker, 0.0, reference_part));
    const auto image = store_.read(request.id, want::image);
    const auto visibility = store_.read(request.id, want::visibility);
    const json record = store_.find(request.id);
    if (image && visibility && !record.is_null())
      return {request.id, *image, *visibility, record.value("noise_rms_y", json(nullptr))};
  }
  throw Error("internal", "the reference was drawn but could not be kept: is the disk full?");
}

/// Runs a task. Throws WorkerLost where the worker died at it.
Message QueuedRenderService::run(Job& job, const Message& task, Crewman& worker, double from,
                                 double to) {
  const auto progress = [&](double value) {
    const Lock lock(mutex_);
    job.record.progress = from + (to - from) * value;
    job.moved.notify_all();
  };
  {
    const Lock lock(mutex_);
    job.task = task.body.at("task").at("id");
    if (deaths_.refuses(job.task))
      throw unsupported(
          "what this is measured against ended the renderer twice; it is refused "
          "until the server is started again");
  }
  try {
    Message result =
        worker->run(task, options_.deadline_s, progress, [&] { return job.cancelled.load(); });
    crew_.succeeded();
    const Lock lock(mutex_);
    ++counters_["rendered"];
    return result;
  } catch (const WorkerLost& lost) {
    crew_.ended();
    crew_.failed(lost.what());
    throw;
  } catch (const WorkCancelled&) {
    crew_.ended();
    throw;
  } catch (const Error& error) {
    if (worker->alive()) throw;  // the request is at fault, the worker is fine
    crew_.ended();
    if (error.code != "device") throw;
    crew_.failed(error.what());
    throw WorkerLost(error.what());
  }
}

void QueuedRenderService::keep(const CanonicalRequest& request, const json& device,
                               const Message& result) {
  const json& done = result.body.at("done");
  json record = store_.find(request.id);
  if (record.is_null())
    record = {{"request", request.request},
              {"cost", nullptr},
              {"quality", nullptr},
              {"notes", json::array()}};
  record["device"] = device;
  const bool measured = !done.at("cost").is_null() || !done.at("quality").is_null();
  if (measured) record["notes"] = json::array();
  for (const json& note : done.at("notes"))
    if (std::find(record["notes"].begin(), record["notes"].end(), note) == record["notes"].end())
      record["notes"].push_back(note);
  for (const char* key : {"cost", "quality"})
    if (!done.at(key).is_null()) record[key] = done.at(key);
  if (done.contains("noise_rms_y")) record["noise_rms_y"] = done.at("noise_rms_y");
  store_.put(request.id, record, result.blobs);
}

void QueuedRenderService::finish(const std::shared_ptr<Job>& job, const std::set<std::string>& done,
                                 const std::string& status, const json& error) {
  const std::string id = job->record.id;
  const auto found = status == "done" ? stored(id) : std::nullopt;
  const Lock lock(mutex_);
  queue_.finished(*job);
  const bool more = status == "done" && !job->cancelled &&
                    !std::includes(done.begin(), done.end(), job->wants.begin(), job->wants.end());
  // It may have been asked for anew between its cancelling and its end.
  const bool wanted_again = status == "cancelled" && !job->submitters.empty() && !stopping_;
  if (more || wanted_again) {
    job->cancelled = false;
    job->record.status = "queued";
    job->alone = job->wants.contains(want::cost);
    queue_.push(job);
    job->moved.notify_all();
    changed_.notify_all();
  } else {
    if (found) {
      job->record = *found;
    } else {
      job->record.status = status;
      job->record.error = error;
      remember(job->record);
    }
    if (status != "done") ++counters_[status];
    if (status == "failed" && error.at("code") == "deadline") ++counters_["deadlines"];
    end(*job);
  }
}

}  // namespace penumbra::server
