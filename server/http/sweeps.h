#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/jobs/render_service.h"
#include "server/storage/sweeps.h"

namespace penumbra::server::http {

/// Where a sweep stands.
struct SweepState {
  std::string id;
  std::vector<nlohmann::json> requests;              ///< in order of rows
  std::vector<std::optional<RenderRecord>> records;  ///< of those that are over
  std::size_t over = 0;
  std::size_t failed = 0;

  bool done() const { return over == requests.size(); }
};

/// Measures every combination of scenes, techniques and sizes, one after the other on one thread
/// per sweep. Only the request is stored: after a restart the renders come from the cache.
class Sweeps {
 public:
  Sweeps(storage::Database& database, RenderService& renders_)
      : stored(database), renders(renders_) {}
  ~Sweeps() { stop(); }

  /// Throws bad_value naming the field. The first request is checked by asking for it.
  SweepState start(const nlohmann::json& request, const std::string& id, const std::string& now);
  std::optional<SweepState> find(const std::string& id);
  /// Blocks until more than `over` renders are over or `seconds` have passed.
  std::optional<SweepState> wait(const std::string& id, std::size_t over, double seconds);
  void stop();

 private:
  struct Running {
    SweepState state;
    std::thread thread;
  };
  Running& run(const std::string& id, const nlohmann::json& request);
  Running* known(const std::string& id);
  void render_all(Running& running);

  storage::SweepRequests stored;
  RenderService& renders;
  std::atomic<bool> stopping{false};
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::string, std::unique_ptr<Running>> sweeps;
};

}  // namespace penumbra::server::http
