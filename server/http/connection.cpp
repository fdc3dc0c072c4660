#include "server/http/connection.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <charconv>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

namespace penumbra::server::http {
namespace {

/// Port of a socket address, -1 for other families.
int port_of(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET)
    return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
  if (address.ss_family == AF_INET6)
    return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
  return -1;
}

std::string host_of(const sockaddr_storage& address) {
  char text[INET6_ADDRSTRLEN] = {};
  const void* bytes =
      address.ss_family == AF_INET
          ? static_cast<const void*>(&reinterpret_cast<const sockaddr_in&>(address).sin_addr)
          : static_cast<const void*>(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
  return inet_ntop(address.ss_family, bytes, text, sizeof text) != nullptr ? text : "";
}

struct Ends {
  sockaddr_storage here{};
  sockaddr_storage there{};
};

/// Both ends of a connected socket; empty for any other descriptor.
std::optional<Ends> ends_of(int descriptor) {
  Ends ends;
  socklen_t here_size = sizeof ends.here;
  socklen_t there_size = sizeof ends.there;
  if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&ends.there), &there_size) != 0 ||
      ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&ends.here), &here_size) != 0)
    return std::nullopt;
  return ends;
}

/// Calls `take(descriptor, ends)` for the process's connections until it returns true.
template <class Take>
void each_connection(Take take) {
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir("/proc/self/fd"), &::closedir);
  if (!folder) return;
  while (const auto* entry = ::readdir(folder.get())) {
    int descriptor = -1;
    std::from_chars(entry->d_name, entry->d_name + std::strlen(entry->d_name), descriptor);
    if (descriptor < 0) continue;
    const auto ends = ends_of(descriptor);
    if (ends && take(descriptor, *ends)) return;
  }
}

}  // namespace

Connection::Connection(const httplib::Request& request) {
  each_connection([&](int candidate, const Ends& ends) {
    if (port_of(ends.there) != request.remote_port || port_of(ends.here) != request.local_port ||
        host_of(ends.there) != request.remote_addr)
      return false;
    descriptor = candidate;
    return true;
  });
}

bool Connection::closed_by_peer() const {
  if (descriptor < 0) return false;
  char byte = 0;
  return ::recv(descriptor, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
}

void shut_reading(int port) {
  each_connection([&](int descriptor, const Ends& ends) {
    if (port_of(ends.here) == port) ::shutdown(descriptor, SHUT_RD);
    return false;
  });
}

}  // namespace penumbra::server::http
