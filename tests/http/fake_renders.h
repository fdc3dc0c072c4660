#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>

#include "renderer/error.h"
#include "server/jobs/digest.h"
#include "server/jobs/render_service.h"
#include "tests/http/png_files.h"

namespace penumbra::server::http {

/// Stands in for the worker processes: pictures of one grey value per technique. The scene's name
/// says how a render goes: `slow` stays queued until `finish`, `broken` fails, `full` finds no
/// room, `wide` is a bad value; every other is done at once.
class FakeRenders : public RenderService {
 public:
  RenderRecord submit(const nlohmann::json& request) override {
    const std::lock_guard lock(mutex);
    if (!request.contains("scene")) throw bad_value("scene", "is required");
    const auto scene = request.at("scene").get<std::string>();
    if (scene == "full") throw Error("busy", "the queue is full");
    if (scene == "wide") throw bad_value("width", "must be from 1 to 8192");
    RenderRecord record;
    record.request = request;
    record.id = sha256(request.dump()).substr(0, 32);
    ++submitted;
    if (records.contains(record.id)) return records[record.id];
    record.status = scene == "slow" ? "queued" : scene == "broken" ? "failed" : "done";
    record.progress = record.status == "done" ? 1.0 : 0.0;
    record.device = {{"name", "fake"}, {"driver", "1"}, {"type", "cpu"}};
    if (scene == "broken")
      record.error = {{"code", "deadline"}, {"message", "took too long"}, {"field", ""}};
    return records[record.id] = record;
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

  bool cancel(const std::string& id) override {
    const std::lock_guard lock(mutex);
    if (!records.contains(id)) return false;
    if (records[id].status == "queued") records[id].status = "cancelled";
    changed.notify_all();
    return true;
  }

  std::optional<std::string> artefact(const std::string& id, const std::string& name) override {
    const std::lock_guard lock(mutex);
    if (!records.contains(id) || name != "image.png") return std::nullopt;
    return png_of(records[id].request.value("technique", ""));
  }

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

 private:
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::string, RenderRecord> records;
};

}  // namespace penumbra::server::http
