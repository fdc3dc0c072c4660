#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
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

/// What a sweep asks for: every combination, techniques varying fastest, made one by one.
class SweepRequests {
 public:
  /// Throws bad_value naming the field.
  explicit SweepRequests(const nlohmann::json& request);

  std::size_t size() const { return scenes.size() * sizes.size() * techniques.size(); }
  nlohmann::json at(std::size_t row) const;

 private:
  std::vector<nlohmann::json> scenes, sizes, techniques;
  nlohmann::json measure;
};

/// How far a sweep is.
struct SweepState {
  std::string id;
  std::size_t total = 0;
  std::size_t over = 0;
  std::size_t failed = 0;

  bool done() const { return over == total; }
};

/// Measures all that sweeps ask for, each in its order, a few sweeps at a time. Only the request is
/// stored: after a restart, or once many others were asked for, the renders come from the cache.
class Sweeps {
 public:
  Sweeps(storage::Database& database, RenderService& renders_)
      : stored(database), renders(renders_) {}
  ~Sweeps() { stop(); }

  /// Throws bad_value naming the field.
  SweepState start(const nlohmann::json& request, const std::string& id, const std::string& now);
  std::optional<SweepState> find(const std::string& id);
  /// Blocks until more than `over` renders are over or `seconds` have passed.
  std::optional<SweepState> wait(const std::string& id, std::size_t over, double seconds);
  /// The rows that are over, as CSV.
  std::optional<std::string> results(const std::string& id);
  void stop();

  /// Gauges for /metrics.
  nlohmann::json statistics();

 private:
  struct Sweep {
    Sweep(std::string id, SweepRequests requests);
    SweepState state;
    SweepRequests requests;
    std::string rows;  ///< CSV of those that are over
  };
  using Shared = std::shared_ptr<Sweep>;

  Shared add(const std::string& id, const nlohmann::json& request);
  Shared known(const std::string& id);
  void forget_old();
  void work();
  void render_all(Sweep& sweep);
  RenderRecord render(const nlohmann::json& request, const Submitter& who);

  storage::SweepRequests stored;
  RenderService& renders;
  std::atomic<bool> stopping{false};
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::string, Shared> sweeps;
  std::deque<std::string> order;  ///< of `sweeps`, the oldest first
  std::deque<Shared> waiting;
  std::vector<std::thread> threads;
  std::size_t idle = 0;  ///< threads that wait for a sweep
  std::size_t running = 0;
};

}  // namespace penumbra::server::http
