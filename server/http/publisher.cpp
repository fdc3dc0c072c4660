#include "server/http/publisher.h"

#include <spdlog/spdlog.h>

#include <chrono>

#include "renderer/error.h"
#include "server/http/clock.h"
#include "server/http/frozen_study.h"
#include "server/http/png.h"
#include "server/http/reply.h"
#include "study/study.h"

namespace penumbra::server::http {
namespace {

/// Thrown to leave a publication where it is; the next start goes on with it.
struct Stopped {};

constexpr double look_s = 1.0;   // how often a waiting publication looks whether to stop
constexpr double pause_s = 0.2;  // before the next try where queue, disk or database had no room

}  // namespace

void Publisher::publish(const storage::StudyRecord& draft) {
  if (draft.status != "draft") throw Error("conflict", "only a draft can be published", "status");
  const auto study = study::parse_study(draft.document);
  const auto all = study::all_renders(study);
  studies.start_publishing(draft.id, draft.version, study::study_hash(study),
                           static_cast<int>(all.size()));
  start(*studies.find(draft.id, draft.version));
}

void Publisher::resume() {
  for (const auto& record : studies.being_published()) start(record);
}

void Publisher::resume(const storage::StudyRecord& publishing) {
  {
    const std::lock_guard lock(mutex);
    const auto found = publications.find(publishing.id);
    if (found != publications.end() && !found->second->over) return;
  }
  start(publishing);
}

void Publisher::start(const storage::StudyRecord& record) {
  const std::lock_guard lock(mutex);
  if (stopping) return;
  auto& publication = publications[record.id];
  // The study was a draft again, or its thread is over: nothing is waited for here.
  if (publication && publication->thread.joinable()) publication->thread.join();
  publication = std::make_unique<Publication>();
  publication->thread = std::thread([this, record, &over = publication->over] {
    run(record);
    over = true;
  });
}

void Publisher::stop() {
  stopping = true;
  const std::lock_guard lock(mutex);
  for (auto& [id, publication] : publications)
    if (publication->thread.joinable()) publication->thread.join();
}

void Publisher::insist(const std::string& doing, const std::function<void()>& step) {
  std::string last;
  while (true) {
    if (stopping) throw Stopped{};
    try {
      return step();
    } catch (const Error& error) {
      if (error.code == "draining") throw Stopped{};
      if (error.code != "busy" && error.code != "storage") throw;
      if (error.what() != last) spdlog::warn("{} is tried again: {}", doing, error.what());
      last = error.what();
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(pause_s));
  }
}

void Publisher::run(const storage::StudyRecord& record) {
  const auto name = "publication of study " + record.id;
  try {
    const auto study = study::parse_study(record.document);
    const auto all = study::all_renders(study);
    for (const auto& request : all) submit(record, request);  // all workers have something to do
    for (const auto& request : all) insist(name, [&] { render_one(record, request); });
    insist(name, [&] {
      for (const auto& [request, picture] : studies.pictures(record.id, record.version))
        pictures.read(picture.digest);
      studies.open(record.id, record.version, utc_now());
    });
    spdlog::info("study {} version {} is open", record.id, record.version);
  } catch (const Stopped&) {
    spdlog::info("{} goes on at the next start", name);
  } catch (...) {
    const Error error = error_of(std::current_exception());
    spdlog::error("study {} cannot be published: {}", record.id, error.what());
    try {
      insist(name, [&] {
        studies.fail_publishing(record.id, record.version, error_body(error).at("error"));
      });
    } catch (const Stopped&) {
      spdlog::info("{} fails again at the next start", name);
    }
  }
}

RenderRecord Publisher::submit(const storage::StudyRecord& record, const nlohmann::json& request) {
  // Participants wait for it, and nothing that others send may end it.
  const Submitter who{Priority::publication, record.id, {"publication of " + record.id}, {}};
  RenderRecord submitted;
  insist("a picture of study " + record.id, [&] { submitted = renders.submit(request, who); });
  return submitted;
}

void Publisher::render_one(const storage::StudyRecord& record, const nlohmann::json& request) {
  auto render = submit(record, request);
  // Where no worker can be had for a while, those that wait end as `busy`: asked for again, they
  // wait.
  while (!is_over(render) || (render.status == "failed" && failure_of(render).code == "busy")) {
    if (stopping) throw Stopped{};
    const auto later = is_over(render) ? std::nullopt : renders.wait(render.id, look_s);
    render = later ? *later : submit(record, request);
  }
  if (render.status != "done") {
    if (stopping) throw Stopped{};
    const auto& why = render.error;
    const std::string name = request.value("scene", "") + " with " + request.value("technique", "");
    throw Error(why.is_object() ? why.value("code", "internal") : "cancelled",
                name + ": " + (why.is_object() ? why.value("message", "") : render.status));
  }
  const auto png = renders.artefact(render.id, "image.png");
  if (!png) throw Error("storage", "the picture of " + render.id + " is gone");
  const auto digest = pictures.freeze(packed_tightly(*png));
  pictures.read_webp(digest);  // made now, so that no participant waits for it
  studies.count_picture(record.id, record.version, request_key(request), {render.id, digest});
}

}  // namespace penumbra::server::http
