#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "server/http/routes.h"
#include "server/http/serve.h"

namespace penumbra::server::http {

/// Token buckets by client: `burst` calls at once, then `per_second`. Memory is bounded: full
/// buckets are forgotten.
class RateLimiter {
 public:
  RateLimiter(double burst_, double per_second_) : burst(burst_), per_second(per_second_) {}

  /// Takes one from the client's bucket; false where it is empty.
  bool allow(const std::string& client);

  /// True where `allow` would be, without taking.
  bool has_left(const std::string& client);

 private:
  using Clock = std::chrono::steady_clock;
  struct Bucket {
    double left;
    Clock::time_point at;
  };
  double refilled(const Bucket& bucket, Clock::time_point now) const;

  double burst;
  double per_second;
  std::mutex mutex;
  std::unordered_map<std::string, Bucket> buckets;
};

/// So many may hold a thread for long at once: those who wait for a render or watch its progress.
class Allowance {
 public:
  explicit Allowance(int most) : left(most) {}

  /// A place, kept as long as the pointer lives. Throws busy where none is left.
  std::shared_ptr<void> take();

 private:
  std::atomic<int> left;
};

/// Who calls: the address that the reverse proxy on this machine reports, otherwise the peer's.
std::string client_of(const httplib::Request& request);

/// True where a reverse proxy speaks for the client.
bool behind_proxy(const httplib::Request& request);

/// True for the researcher's token or session. Throws too_many for a client with too many wrong
/// ones, before it looks: a right guess among them is told from a wrong one by nothing.
bool is_researcher(Service& service, const httplib::Request& request);

/// Throws bad_value (field public_url) for what is no address of a site; empty is fine.
void check_public_url(const std::string& url);

/// True where only programs of this machine reach the server: its renders need no token.
bool is_local(const ServeOptions& options);

/// Throws unauthorized, forbidden (a call from another site), too_many, or draining.
void check_permission(Service& service, const Route& route, const httplib::Request& request);

/// Counts a wrong token or code; throws too_many where the client had too many.
void count_failure(Service& service, const httplib::Request& request);

/// Value of the session cookie, which is not the token itself.
std::string session_of(const std::string& token);
inline constexpr const char* session_cookie = "penumbra_session";

}  // namespace penumbra::server::http
