#include "server/http/publisher.h"

#include <spdlog/spdlog.h>

#include <chrono>

#include "renderer/error.h"
#include "server/http/clock.h"
#include "server/http/frozen_study.h"
#include "server/http/measured_pictures.h"
#include "server/http/png.h"
#include "server/http/reply.h"
#include "study/study.h"

namespace penumbra::server::http {
namespace {

/// Thrown to leave a publication where it is; the next start goes on with it.
struct Stopped {};

constexpr double look_s = 1.0;   // how often a waiting publication looks whether to stop
constexpr double pause_s = 0.2;  // before the next try where queue, disk or database had no room

/// Participants wait for it, and nothing that others send may end it.
Submitter publisher_of(const storage::StudyRecord& record) {
  return {Priority::publication, record.id, {"publication of " + record.id}, {}};
}

std::string publication_name(const storage::StudyRecord& record) {
  return "publication of study " + record.id;
}

std::string measurement_name(const storage::StudyRecord& record) {
  return "measurement of study " + record.id + " version " + std::to_string(record.version);
}

}  // namespace

void Publisher::publish(const storage::StudyRecord& draft) {
  if (draft.status != "draft") throw Error("conflict", "only a draft can be published", "status");
  const auto study = study::parse_study(draft.document);
  const auto all = study::all_renders(study);
  studies.start_publishing(draft.id, draft.version, study::study_hash(study),
                           static_cast<int>(all.size()));
  const auto record = *studies.find(draft.id, draft.version);
  start(publication_name(record), Earlier::await, [this, record] { run(record); });
}

void Publisher::resume() {
  for (const auto& record : studies.being_published()) resume(record);
}

void Publisher::resume(const storage::StudyRecord& publishing) {
  start(publication_name(publishing), Earlier::keep, [this, publishing] { run(publishing); });
}

void Publisher::measure(const storage::StudyRecord& published) {
  start(measurement_name(published), Earlier::keep,
        [this, published] { run_measurement(published); });
}

bool Publisher::is_measuring(const storage::StudyRecord& published) {
  const std::lock_guard lock(mutex);
  const auto found = publications.find(measurement_name(published));
  return found != publications.end() && !found->second->over;
}

void Publisher::start(const std::string& name, Earlier earlier, const std::function<void()>& work) {
  const std::lock_guard lock(mutex);
  if (stopping) return;
  auto& publication = publications[name];
  if (publication && !publication->over && earlier == Earlier::keep) return;
  if (publication) publication->thread.join();
  publication = std::make_unique<Publication>();
  publication->thread = std::thread([work, &over = publication->over] {
    work();
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
  const auto name = publication_name(record);
  try {
    const auto study = study::parse_study(record.document);
    const auto all = study::all_renders(study);
    for (const auto& request : all)  // all workers have something to do
      if (study::own_picture(request).empty()) submit(request, publisher_of(record));
    for (const auto& request : all)
      insist(name, [&] {
        if (study::own_picture(request).empty())
          render_one(record, request);
        else
          freeze_own(record, request);
      });
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

RenderRecord Publisher::submit(const nlohmann::json& request, const Submitter& who) {
  RenderRecord submitted;
  insist("a picture for " + who.client, [&] { submitted = renders.submit(request, who); });
  return submitted;
}

RenderRecord Publisher::finished(const nlohmann::json& request, const Submitter& who) {
  auto render = submit(request, who);
  // Where no worker can be had for a while, those that wait end as `busy`: asked for again, they
  // wait.
  while (!is_over(render) || (render.status == "failed" && failure_of(render).code == "busy")) {
    if (stopping) throw Stopped{};
    const auto later = is_over(render) ? std::nullopt : renders.wait(render.id, look_s);
    render = later ? *later : submit(request, who);
  }
  if (render.status == "done") return render;
  if (stopping) throw Stopped{};
  const auto& why = render.error;
  const std::string name = request.value("scene", "") + " with " + request.value("technique", "");
  throw Error(why.is_object() ? why.value("code", "internal") : "cancelled",
              name + ": " + (why.is_object() ? why.value("message", "") : render.status));
}

void Publisher::render_one(const storage::StudyRecord& record, const nlohmann::json& request) {
  const auto render = finished(request, publisher_of(record));
  const auto png = renders.artefact(render.id, "image.png");
  if (!png) throw Error("storage", "the picture of " + render.id + " is gone");
  freeze(record, request, render.id, *png, measures_of(render));
}

void Publisher::freeze_own(const storage::StudyRecord& record, const nlohmann::json& request) {
  const auto name = study::own_picture(request);
  const auto png = pictures.read_stored(name);
  if (!png) throw not_found("picture", "the picture " + name + " is not here; upload it again");
  freeze(record, request, name, *png, nlohmann::json::object());
}

void Publisher::freeze(const storage::StudyRecord& record, const nlohmann::json& request,
                       const std::string& source, const std::string& png,
                       const nlohmann::json& measures) {
  const auto digest = pictures.freeze(packed_tightly(png));
  pictures.read_webp(digest);  // made now, so that no participant waits for it
  studies.count_picture(record.id, record.version, request_key(request),
                        {source, digest, measures});
}

void Publisher::run_measurement(const storage::StudyRecord& record) {
  const auto name = measurement_name(record);
  const Submitter who{Priority::researcher, name, {name}, {}};
  struct Unmeasured {
    std::string key;
    std::string render;  ///< that was frozen
    nlohmann::json request;
  };
  std::vector<Unmeasured> left;
  try {
    insist(name, [&] {
      left.clear();
      const auto known = studies.pictures(record.id, record.version);
      for (auto request : study::all_renders(study::parse_study(record.document))) {
        const auto key = request_key(request);
        const auto found = known.find(key);
        if (found == known.end() || !found->second.measures.is_null()) continue;
        request["measure"] = true;
        left.push_back({key, found->second.render, request});
      }
    });
    for (const auto& picture : left) {
      try {
        const auto render = finished(picture.request, who);
        if (render.id != picture.render)
          throw Error("conflict", "this program draws another picture than the one that was shown");
        insist(name, [&] {
          studies.set_measures(record.id, record.version, picture.key, measures_of(render));
        });
      } catch (const Error& error) {
        spdlog::warn("{}: {}", name, error.what());  // the others are measured all the same
      }
    }
    spdlog::info("{} is over", name);
  } catch (const Stopped&) {
    spdlog::info("{} was ended by the stop; ask again for the rest", name);
  } catch (...) {
    spdlog::error("{} ended: {}", name, error_of(std::current_exception()).what());
  }
}

}  // namespace penumbra::server::http
