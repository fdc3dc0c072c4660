#include "server/http/connection.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace penumbra::server::http {
namespace {

constexpr std::size_t head_block = 16 << 10;    // bytes received at once
constexpr std::size_t most_blocks = 8;          // before others have their turn
constexpr std::size_t most_dropped = 64 << 20;  // bytes of a refused client that are read
constexpr std::size_t unjudged = 4096;          // bytes of one line before it is looked at again

}  // namespace

Connection::Connection(int descriptor_, const ConnectionLimits& limits_)
    : descriptor(descriptor_), limits(limits_), since(Clock::now()), due(since + limits.head) {}

Connection::~Connection() {
  ::close(descriptor);
}

Connection::State Connection::receive(std::span<const std::string> methods) {
  auto state = judge(methods);  // of what came behind the last request
  for (std::size_t i = 0; state == State::waiting && i < most_blocks; ++i) {
    std::array<char, head_block> bytes;
    const auto count = ::recv(descriptor, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return State::waiting;
    if (count <= 0) return State::gone;
    if (input.empty()) {
      since = Clock::now();
      due = since + limits.head;
    }
    input.append(bytes.data(), static_cast<std::size_t>(count));
    state = judge(methods);
  }
  return state;
}

Connection::State Connection::judge(std::span<const std::string> methods) {
  if (refused) return State::refused;
  if (!whole_head) {
    // A line that comes byte by byte is not read anew for each of them.
    const bool new_line = input.find('\n', judged) != std::string::npos;
    if (!new_line && input.size() < judged + unjudged) return State::waiting;
    judged = input.size();
    try {
      whole_head = read_head(input, methods, head);
    } catch (const Error& error) {
      return refuse(error);
    }
    if (!whole_head) return State::waiting;
    framing = BodyFraming(head);
    framed = head.size;
    since = Clock::now();
  }
  framed += framing.take(std::string_view(input).substr(framed));
  if (framing.broken()) return refuse(bad_value("body", "its chunks cannot be read"));
  if (framing.done()) return State::ready;
  if (head.content_length > limits.buffered_body || framed - head.size > limits.buffered_body)
    return State::ready;
  const std::chrono::duration<double> time(static_cast<double>(framed) / limits.least_rate);
  due = since + limits.patience + std::chrono::duration_cast<Clock::duration>(time);
  tell_to_continue();
  return State::waiting;
}

Connection::State Connection::refuse(const Error& error) {
  refused = error;
  return State::refused;
}

void Connection::tell_to_continue() {
  if (!head.expects_continue || continued) return;
  continued = true;
  constexpr std::string_view text = "HTTP/1.1 100 Continue\r\n\r\n";
  // So few bytes find room, or the client is gone, which the next look at the socket shows.
  [[maybe_unused]] const auto sent =
      ::send(descriptor, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void Connection::next() {
  input.erase(0, framed);
  head = {};
  judged = 0;
  framed = 0;
  whole_head = false;
  continued = false;
  since = Clock::now();
  due = since + (input.empty() ? limits.idle : limits.head);
}

void Connection::part(const std::string& answer) {
  std::size_t sent = 0;
  while (sent < answer.size()) {
    const auto count =
        ::send(descriptor, answer.data() + sent, answer.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count <= 0) break;  // a client that reads nothing needs no reason
    sent += static_cast<std::size_t>(count);
  }
  // Closing at once would reset the connection where bytes are unread, and lose the answer.
  ::shutdown(descriptor, SHUT_WR);
  leaving = true;
  input = {};
  since = Clock::now();
  due = since + limits.farewell;
}

bool Connection::drop_rest() {
  std::array<char, head_block> bytes;
  while (dropped < most_dropped) {
    const auto count = ::recv(descriptor, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    if (count == 0) return false;
    dropped += static_cast<std::size_t>(count);
  }
  return false;
}

}  // namespace penumbra::server::http
