#include "server/http/connection.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <charconv>
#include <cstring>
#include <memory>

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

bool connects(int descriptor, const httplib::Request& request) {
  sockaddr_storage here{};
  sockaddr_storage there{};
  socklen_t here_size = sizeof here;
  socklen_t there_size = sizeof there;
  if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&there), &there_size) != 0 ||
      ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&here), &here_size) != 0)
    return false;
  return port_of(there) == request.remote_port && port_of(here) == request.local_port &&
         host_of(there) == request.remote_addr;
}

}  // namespace

Connection::Connection(const httplib::Request& request) {
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir("/proc/self/fd"), &::closedir);
  if (!folder) return;
  while (const auto* entry = ::readdir(folder.get())) {
    int number = -1;
    std::from_chars(entry->d_name, entry->d_name + std::strlen(entry->d_name), number);
    if (number < 0 || !connects(number, request)) continue;
    descriptor = number;
    return;
  }
}

bool Connection::closed_by_peer() const {
  if (descriptor < 0) return false;
  char byte = 0;
  return ::recv(descriptor, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
}

}  // namespace penumbra::server::http
