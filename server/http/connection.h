#pragma once

#include <httplib.h>

namespace penumbra::server::http {

/// The socket a request came by, to notice that its client hung up while it waits. The library
/// hands handlers no socket, so it is found among the process's by the addresses of both ends.
class Connection {
 public:
  explicit Connection(const httplib::Request& request);

  /// False as long as the client may still read an answer, and where the socket was not found.
  bool closed_by_peer() const;

 private:
  int descriptor = -1;
};

/// Lets no more be read from connections to a port of this process: idle ones end, answers on their
/// way still leave.
void shut_reading(int port);

}  // namespace penumbra::server::http
