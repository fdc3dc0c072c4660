#pragma once

#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>

#include "server/http/connection.h"

namespace penumbra::server::http {

/// Time that a client has left: what passes while it is waited for is spent, bytes that it takes or
/// sends give some back, never more than there was at first. A burst buys no long silence.
class Patience {
 public:
  explicit Patience(const ConnectionLimits& limits)
      : most(limits.patience), least_rate(limits.least_rate), left(most) {}

  /// False once there is none left.
  bool spend(std::chrono::duration<double> time, double bytes) {
    left = std::min(most, left - time + std::chrono::duration<double>(bytes / least_rate));
    return left.count() > 0.0;
  }

 private:
  std::chrono::duration<double> most;
  double least_rate;
  std::chrono::duration<double> left;
};

/// A request as the library reads it: its checked head, then its body to the end and no byte
/// further. The answer goes out by it. Clients that are too slow at either are given up.
class RequestStream : public httplib::Stream {
 public:
  /// `stopping` ends waiting for bodies.
  RequestStream(Connection& connection_, const std::atomic<bool>& stopping_);
  ~RequestStream() override;
  RequestStream(const RequestStream&) = delete;
  RequestStream& operator=(const RequestStream&) = delete;

  /// The one that this thread handles: the library hands handlers no stream.
  static RequestStream& current();

  /// False as long as the client may still read an answer.
  bool closed_by_peer() const;

  /// The library parsed the head.
  void set_understood() { understood = true; }

  /// Called when the head of the answer is about to leave: an answer to what was not understood, or
  /// whose body is still on its way, ends the connection and says so.
  void finish_head(httplib::Response& response);

  /// False where no further request can follow.
  bool reusable() const { return !closing && !failed && connection.framing.done(); }

  bool is_readable() const override { return position < connection.framed; }
  bool is_writable() const override { return !failed; }
  ssize_t read(char* into, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& address, int& port) const override;
  void get_local_ip_and_port(std::string& address, int& port) const override;
  socket_t socket() const override { return connection.descriptor; }

 private:
  /// Waits for bytes of the body. False where none will come.
  bool receive();
  bool wait_until_writable();

  Connection& connection;
  const std::atomic<bool>& stopping;
  std::size_t position = 0;  ///< in the connection's input
  double sent = 0.0;         ///< handed to the system; bytes
  double taken = 0.0;        ///< of these, by the client when it was looked at last; bytes
  Patience with_body;
  Patience with_reader;
  bool understood = false;
  bool closing = false;
  bool failed = false;
};

}  // namespace penumbra::server::http
