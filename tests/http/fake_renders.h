#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "renderer/error.h"
#include "server/files/digest.h"
#include "server/jobs/render_service.h"
#include "tests/http/png_files.h"

namespace penumbra::server::http {

/// In place of the worker processes: pictures of one grey value per technique. The scene's name
/// says how a render goes: `slow` stays queued until `finish`, `broken` fails, `full` finds no
/// room, `wide` is a bad value; every other is done at once.
class FakeRenders : public RenderService {
 public:
  RenderRecord submit(const nlohmann::json& request, const Submitter& who) override {
    const std::lock_guard lock(mutex);
    if (!request.contains("scene")) throw bad_value("scene", "is required");
    const auto scene = request.at("scene").get<std::string>();
    if (scene == "full") throw Error("busy", "the queue is full");
    if (scene == "wide") throw bad_value("width", "must be from 1 to 8192");
    RenderRecord record;
    record.request = request;
    // Whether it is measured as well makes no other picture.
    auto drawn = request;
    drawn.erase("measure");
    if (another_program) drawn["drawn_by"] = "another program";
    record.id = sha256(drawn.dump()).substr(0, 32);
    ++submitted;
    submitters[record.id].push_back(who);
    const bool measure = request.value("measure", false);
    const auto known = records.find(record.id);
    if (known != records.end() && known->second.status != "cancelled" &&
        (!measure || !known->second.cost.is_null()))
      return known->second;
    if (measure) {
      const bool reference = request.at("technique") == "reference";
      const double error = error_of(request);
      record.cost = {{"frame_ms", {{"median", 100.0 - error}}}};
      record.quality = {
          {"reference_id", reference ? record.id : "another"}, {"rms_y", error}, {"ssim", nullptr}};
    }
    record.status = scene == "slow" ? "queued" : scene == "broken" ? "failed" : "done";
    record.progress = record.status == "done" ? 1.0 : 0.0;
    record.device = {{"name", "fake"}, {"driver", "1"}, {"type", "cpu"}};
    if (scene == "broken")
      record.error = {{"code", "deadline"}, {"message", "took too long"}, {"field", ""}};
    return records[record.id] = record;
  }

  void check(const nlohmann::json& request) override {
    const auto& scene = request.at("scene");
    if (scene == "wide") throw bad_value("width", "must be from 1 to 8192");
    if (scene == "nowhere") throw not_found("scene", "there is no such scene");
    if (request.at("technique") == "unheard-of")
      throw not_found("technique", "there is no such technique");
    if (request.at("parameters").contains("sise")) throw bad_value("sise", "unknown parameter");
    if (request.value("camera", "") == "behind")
      throw not_found("camera", "there is no such camera");
  }

  std::optional<RenderRecord> find(const std::string& id) override {
    const std::lock_guard lock(mutex);
    if (!records.contains(id)) return std::nullopt;
    return records[id];
  }

  std::optional<RenderRecord> wait(const std::string& id, double seconds) override {
    std::unique_lock lock(mutex);
    if (!records.contains(id)) return std::nullopt;
    changed.wait_for(lock, std::chrono::duration<double>(seconds),
                     [&] { return records[id].status != "queued"; });
    return records[id];
  }

  std::optional<RenderRecord> wait_change(const std::string& id, const RenderRecord& seen,
                                          double seconds) override {
    std::unique_lock lock(mutex);
    if (!records.contains(id)) return std::nullopt;
    changed.wait_for(lock, std::chrono::duration<double>(seconds),
                     [&] { return records[id].status != seen.status; });
    return records[id];
  }

  bool release(const std::string& id, const std::set<std::string>& keys) override {
    const std::lock_guard lock(mutex);
    if (!records.contains(id) || is_over(records[id])) return false;
    auto& all = submitters[id];
    const auto released = std::erase_if(all, [&](const Submitter& who) {
      return std::any_of(keys.begin(), keys.end(), [&](const std::string& key) {
        return who.keys.contains(key) || who.further_keys.contains(key);
      });
    });
    if (all.empty()) records[id].status = "cancelled";
    changed.notify_all();
    return released > 0;
  }

  SharedBytes stored_artefact(const std::string& id, const std::string& name) override {
    const std::lock_guard lock(mutex);
    if (!records.contains(id) || records[id].status != "done" || name != "image.png")
      return nullptr;
    return std::make_shared<const std::string>(png_of(records[id].request.value("technique", "")));
  }

  std::optional<RenderRecord> submit_artefact(const std::string&, const std::string&,
                                              const Submitter&) override {
    return std::nullopt;
  }

  std::string trouble() override { return in_trouble; }

  nlohmann::json statistics() override { return {{"workers", 1}, {"queued", 0}}; }

  void drain(double) override {
    const std::lock_guard lock(mutex);
    for (auto& [id, record] : records)
      if (record.status == "queued") record.status = "cancelled";
    changed.notify_all();
  }

  void finish(const std::string& id) {
    const std::lock_guard lock(mutex);
    records[id].status = "done";
    records[id].progress = 1.0;
    changed.notify_all();
  }

  static std::string png_of(const std::string& technique) {
    return grey_png(static_cast<std::uint8_t>(std::hash<std::string>{}(technique) % 256),
                    "drawn by " + technique);
  }

  int submitted = 0;
  bool another_program = false;  ///< draws other pictures of the same requests
  /// Error of a measured picture; its time is 100 ms less that many.
  std::function<double(const nlohmann::json&)> error_of = [](const auto&) { return 1.0; };
  std::string in_trouble;  ///< why nothing can be drawn

  /// Those that have not released a render.
  std::vector<Submitter> submitters_of(const std::string& id) {
    const std::lock_guard lock(mutex);
    return submitters[id];
  }

 private:
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::string, RenderRecord> records;
  std::map<std::string, std::vector<Submitter>> submitters;
};

}  // namespace penumbra::server::http
