#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>

#include "server/http/body_framing.h"
#include "server/http/request_head.h"

namespace penumbra::server::http {

/// How long clients may take, and how much of what they send is kept before a thread is spent on
/// it.
struct ConnectionLimits {
  std::chrono::milliseconds idle{15000};      ///< between two requests
  std::chrono::milliseconds head{10000};      ///< from the first byte of a head to its last
  std::chrono::milliseconds patience{20000};  ///< for a body or an answer, beside the time of its
                                              ///< bytes at the least rate
  double least_rate = 8192.0;                 ///< of bodies and answers; bytes per second
  std::chrono::milliseconds farewell{2000};   ///< for a refused client to read why
  std::size_t buffered_body = 256 << 10;      ///< bodies up to this are whole before a thread
                                              ///< reads them; bytes
};

/// A client's connection: what it sent that was not used yet, and how much of its next request is
/// there. Used by one thread at a time.
class Connection {
 public:
  using Clock = std::chrono::steady_clock;
  enum class State {
    waiting,  ///< more has to come
    ready,    ///< a checked head is there, and its body unless it is large
    refused,  ///< `refusal` says why; nothing of what follows is a request
    gone,     ///< closed by the client, or failed
  };

  /// Owns the socket, which must not block.
  Connection(int descriptor_, const ConnectionLimits& limits_);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Takes what has arrived, without waiting, and says how much of the next request is there.
  State receive(std::span<const std::string> methods);

  /// Forgets the request that was answered; what was sent after it stays.
  void next();

  /// Sends a last answer, if any, and nothing more; what the client still sends is dropped.
  void part(const std::string& answer);

  /// Drops what came after `part`. False once the client closed, or sent too much.
  bool drop_rest();

  /// When the patience with what is awaited ends.
  Clock::time_point deadline() const { return due; }
  Clock::time_point waiting_since() const { return since; }
  bool parted() const { return leaving; }
  bool idle() const { return input.empty(); }
  /// All that came belonged to the request, and nothing of it is still to come.
  bool all_used() const { return framing.done() && input.size() == framed; }
  std::size_t buffered() const { return input.size(); }
  int socket() const { return descriptor; }
  const RequestHead& request() const { return head; }
  const Error& refusal() const { return *refused; }

 private:
  friend class RequestStream;

  State judge(std::span<const std::string> methods);
  State refuse(const Error& error);
  void tell_to_continue();

  int descriptor;
  const ConnectionLimits& limits;
  std::string input;       ///< received: the head until it is taken, the body, what follows
  std::size_t judged = 0;  ///< bytes of `input` when the head was looked at last
  bool whole_head = false;
  bool continued = false;  ///< the client was told to send its body
  RequestHead head;
  BodyFraming framing;
  std::size_t framed = 0;  ///< bytes of `input`, head included, that belong to this request
  std::optional<Error> refused;
  bool leaving = false;
  std::size_t dropped = 0;
  Clock::time_point since;  ///< beginning of the wait for what `due` bounds
  Clock::time_point due;
};

}  // namespace penumbra::server::http
