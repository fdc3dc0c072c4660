#include "server/http/clock.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

namespace penumbra::server::http {

namespace {

std::string text_of(std::int64_t ms) {
  const std::time_t whole = static_cast<std::time_t>(ms / 1000);
  std::tm parts{};
  ::gmtime_r(&whole, &parts);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", parts.tm_year + 1900,
                     parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec,
                     ms % 1000);
}

}  // namespace

std::string utc_now(double seconds) {
  using namespace std::chrono;
  return text_of(duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count() +
                 std::llround(seconds * 1000.0));
}

std::string utc_later(const std::string& time, double seconds) {
  std::tm parts{};
  const char* rest = ::strptime(time.c_str(), "%Y-%m-%dT%H:%M:%S", &parts);
  if (rest == nullptr) throw std::logic_error("no time: " + time);
  const double fraction_s = *rest == '.' ? std::strtod(rest, nullptr) : 0.0;
  return text_of(static_cast<std::int64_t>(::timegm(&parts)) * 1000 +
                 std::llround((fraction_s + seconds) * 1000.0));
}

}  // namespace penumbra::server::http
