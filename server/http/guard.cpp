#include "server/http/guard.h"

#include <algorithm>

#include "renderer/error.h"
#include "server/http/secrets.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

bool loopback(const std::string& address) {
  return address == "127.0.0.1" || address == "::1" || address == "::ffff:127.0.0.1";
}

std::string cookie(const httplib::Request& request, const std::string& name) {
  const auto text = request.get_header_value("Cookie");
  std::size_t start = 0;
  while (start < text.size()) {
    auto end = text.find(';', start);
    if (end == std::string::npos) end = text.size();
    const auto first = text.find_first_not_of(' ', start);
    if (first < end && text.compare(first, name.size() + 1, name + "=") == 0)
      return text.substr(first + name.size() + 1, end - first - name.size() - 1);
    start = end + 1;
  }
  return {};
}

/// Scheme, host and port of an address: https://host:port/path gives https://host:port.
std::string origin_of(const std::string& url) {
  const auto scheme = url.find("://");
  if (scheme == std::string::npos) return {};
  return url.substr(0, url.find('/', scheme + 3));
}

/// A browser names the site a call comes from; programs name none.
void check_origin(const Service& service, const httplib::Request& request) {
  const Error foreign("forbidden", "calls from other sites are refused", "Origin");
  const auto site = request.get_header_value("Sec-Fetch-Site");
  if (site == "cross-site" || site == "same-site") throw foreign;
  if (!request.has_header("Origin")) return;
  const auto origin = request.get_header_value("Origin");
  const auto host = request.get_header_value("Host");
  const bool own = origin == "http://" + host || origin == "https://" + host;
  const bool published = !origin.empty() && origin == origin_of(service.options.public_url);
  if (!own && !published) throw foreign;
}

}  // namespace

bool RateLimiter::allow(const std::string& client) {
  const std::lock_guard lock(mutex);
  const auto now = Clock::now();
  const auto refilled = [&](const Bucket& bucket) {
    const std::chrono::duration<double> passed = now - bucket.at;
    return std::min(burst, bucket.left + per_second * passed.count());
  };
  constexpr std::size_t most = 10000;
  if (buckets.size() >= most)
    std::erase_if(buckets, [&](const auto& entry) { return refilled(entry.second) >= burst; });
  if (buckets.size() >= most && !buckets.contains(client)) return false;
  auto& bucket = buckets.try_emplace(client, Bucket{burst, now}).first->second;
  bucket = {refilled(bucket), now};
  if (bucket.left < 1.0) return false;
  bucket.left -= 1.0;
  return true;
}

bool behind_proxy(const httplib::Request& request) {
  return loopback(request.remote_addr) && request.has_header("X-Real-IP");
}

std::string client_of(const httplib::Request& request) {
  return behind_proxy(request) ? request.get_header_value("X-Real-IP") : request.remote_addr;
}

std::string session_of(const std::string& token) {
  return keyed_digest(token, "session");
}

bool is_researcher(const Service& service, const httplib::Request& request) {
  const auto header = request.get_header_value("Authorization");
  const std::string scheme = "Bearer ";
  if (header.starts_with(scheme))
    return equal_in_constant_time(header.substr(scheme.size()), service.token);
  return equal_in_constant_time(cookie(request, session_cookie), session_of(service.token));
}

void count_failure(Service& service, const httplib::Request& request) {
  if (!service.failures.allow(client_of(request)))
    throw Error("too_many", "too many wrong tokens; wait a little");
}

void check_permission(Service& service, const Route& route, const httplib::Request& request) {
  if (route.method != "GET") {
    check_origin(service, request);
    if (service.draining) throw Error("draining", "the server is stopping");
  }
  if (route.access == Access::researcher && !is_researcher(service, request)) {
    if (request.has_header("Authorization") || !cookie(request, session_cookie).empty())
      count_failure(service, request);
    throw Error("unauthorized", "this needs the researcher's token", "Authorization");
  }
}

}  // namespace penumbra::server::http
