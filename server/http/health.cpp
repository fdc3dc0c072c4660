#include "server/http/health.h"

#include <spdlog/spdlog.h>

#include "renderer/error.h"

namespace penumbra::server::http {
namespace {

constexpr auto interval = std::chrono::seconds(2);  // between two looks
constexpr std::size_t room = 64 << 10;              // bytes: a disk without them is as good as full

}  // namespace

std::string Health::trouble() {
  const std::lock_guard lock(mutex);
  const auto now = std::chrono::steady_clock::now();
  if (now < next) return last;
  auto found = look();
  if (found != last && !found.empty()) spdlog::error("not ready: {}", found);
  if (found != last && found.empty()) spdlog::info("ready again");
  last = std::move(found);
  next = std::chrono::steady_clock::now() + interval;
  return last;
}

std::string Health::look() {
  try {
    if (!database.healthy()) return "the database is damaged: " + database.damage_text();
    database.probe();
    const auto file = folder.path() / "probe";
    storage::write_file_durably(file, std::string(room, '\0'));
    std::filesystem::remove(file);
    pictures.check();
  } catch (const Error& error) {
    // Messages of the file system name paths, which readiness does not show.
    spdlog::error("looking at the data folder: {}", error.what());
    return error.code == "busy" ? error.what() : "nothing can be stored; the log says why";
  } catch (const std::exception& error) {
    spdlog::error("looking at the data folder: {}", error.what());
    return "the data folder cannot be used; the log says why";
  }
  const auto damaged = pictures.damaged();
  if (damaged == 0) return {};
  return std::to_string(damaged) + " pictures of open studies are damaged or missing";
}

}  // namespace penumbra::server::http
