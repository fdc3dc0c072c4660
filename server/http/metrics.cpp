#include "server/http/metrics.h"

#include <sstream>

namespace penumbra::server::http {
namespace {

void write_gauges(std::ostringstream& out, const std::string& prefix, const nlohmann::json& value) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) write_gauges(out, prefix + "_" + key, inner);
  } else if (value.is_number() || value.is_boolean()) {
    out << "# TYPE " << prefix << " gauge\n"
        << prefix << ' ' << (value.is_boolean() ? (value.get<bool>() ? "1" : "0") : value.dump())
        << '\n';
  }
}

}  // namespace

void Metrics::count(const std::string& route, int status, double ms) {
  const std::lock_guard lock(mutex);
  auto& sum = requests[{route, status}];
  ++sum.count;
  sum.ms += ms;
}

std::string Metrics::text(const nlohmann::json& gauges) const {
  std::ostringstream out;
  const std::lock_guard lock(mutex);
  out << "# HELP penumbra_requests_total Requests answered.\n"
         "# TYPE penumbra_requests_total counter\n";
  const auto labels = [](const auto& key) {
    return "{route=\"" + key.first + "\",status=\"" + std::to_string(key.second) + "\"} ";
  };
  for (const auto& [key, sum] : requests)
    out << "penumbra_requests_total" << labels(key) << sum.count << '\n';
  out << "# HELP penumbra_request_seconds_sum Time spent on them.\n"
         "# TYPE penumbra_request_seconds_sum counter\n";
  for (const auto& [key, sum] : requests)
    out << "penumbra_request_seconds_sum" << labels(key) << sum.ms / 1000.0 << '\n';
  write_gauges(out, "penumbra", gauges);
  return out.str();
}

}  // namespace penumbra::server::http
