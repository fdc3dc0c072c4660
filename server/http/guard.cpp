#include "server/http/guard.h"

#include <algorithm>

#include "renderer/error.h"
#include "server/http/secrets.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

bool loopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1" || address.starts_with("::ffff:127.") ||
         address == "localhost";
}

/// Host of "name:port" and "[address]:port".
std::string without_port(const std::string& host) {
  if (host.starts_with('[')) return host.substr(1, host.find(']') - 1);
  return host.substr(0, host.find(':'));
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
  const auto& options = service.options;
  if (!options.public_url.empty()) {
    if (origin != origin_of(options.public_url)) throw foreign;
    return;
  }
  // A page can point a name of its own at this machine: only then is Host not what it seems.
  const auto host = request.get_header_value("Host");
  const bool own = origin == "http://" + host || origin == "https://" + host;
  if (!own || (is_local(options) && !loopback(without_port(host)))) throw foreign;
}

}  // namespace

double RateLimiter::refilled(const Bucket& bucket, Clock::time_point now) const {
  const std::chrono::duration<double> passed = now - bucket.at;
  return std::min(burst, bucket.left + per_second * passed.count());
}

bool RateLimiter::has_left(const std::string& client) {
  const std::lock_guard lock(mutex);
  const auto found = buckets.find(client);
  return found == buckets.end() || refilled(found->second, Clock::now()) >= 1.0;
}

bool RateLimiter::allow(const std::string& client) {
  const std::lock_guard lock(mutex);
  const auto now = Clock::now();
  constexpr std::size_t most = 10000;
  if (buckets.size() >= most)
    std::erase_if(buckets, [&](const auto& entry) { return refilled(entry.second, now) >= burst; });
  if (buckets.size() >= most && !buckets.contains(client)) return false;
  auto& bucket = buckets.try_emplace(client, Bucket{burst, now}).first->second;
  bucket = {refilled(bucket, now), now};
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

bool is_researcher(Service& service, const httplib::Request& request) {
  const auto header = request.get_header_value("Authorization");
  const auto session = cookie(request, session_cookie);
  if (header.empty() && session.empty()) return false;
  const Error too_many("too_many", "too many wrong tokens; wait a little");
  const auto client = client_of(request);
  if (!service.failures.has_left(client)) throw too_many;
  const std::string scheme = "Bearer ";
  const bool right = header.starts_with(scheme)
                         ? equal_in_constant_time(header.substr(scheme.size()), service.token)
                         : equal_in_constant_time(session, session_of(service.token));
  if (!right && !service.failures.allow(client)) throw too_many;
  return right;
}

void check_public_url(const std::string& url) {
  const auto origin = origin_of(url);
  const bool known = origin.starts_with("https://") || origin.starts_with("http://");
  if (!url.empty() && (!known || origin.ends_with("://")))
    throw bad_value("public_url", "must be like https://study.example.org");
}

bool is_local(const ServeOptions& options) {
  return options.public_url.empty() && loopback(options.host);
}

std::shared_ptr<void> Allowance::take() {
  if (left.fetch_sub(1) <= 0) {
    ++left;
    throw Error("busy", "too many wait already; ask again without waiting");
  }
  return {this, [](void* allowance) { ++static_cast<Allowance*>(allowance)->left; }};
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
  const bool open = route.access == Access::anyone ||
                    (route.access == Access::laboratory && is_local(service.options));
  if (!open && !is_researcher(service, request))
    throw Error("unauthorized", "this needs the researcher's token", "Authorization");
}

}  // namespace penumbra::server::http
