#pragma once

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace penumbra::server::http {

/// Counters of requests, by route and state.
class Metrics {
 public:
  void count(const std::string& route, int status, double ms);

  /// Prometheus text format 0.0.4: these counters, and every number of `gauges` as a gauge named
  /// penumbra_KEY (objects nest with an underscore).
  std::string text(const nlohmann::json& gauges) const;

 private:
  struct Sum {
    std::uint64_t count = 0;
    double ms = 0.0;
  };
  mutable std::mutex mutex;
  std::map<std::pair<std::string, int>, Sum> requests;
};

}  // namespace penumbra::server::http
