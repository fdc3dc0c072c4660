#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <string>

namespace penumbra::server::http {

/// What came back for bytes that no well-behaved client sends.
struct RawAnswer {
  std::string text;
  bool closed = false;  ///< by the server, within the time

  int status() const { return text.size() > 12 ? std::stoi(text.substr(9, 3)) : 0; }
};

/// Sends bytes as they are and reads until the server closes or `seconds` pass in silence.
inline RawAnswer send_raw(int port, const std::string& bytes, int seconds = 2) {
  RawAnswer answer;
  const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval patience{seconds, 0};
  ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (::connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const auto count = ::send(descriptor, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) break;
      sent += static_cast<std::size_t>(count);
    }
    char buffer[65536];
    while (true) {
      const auto count = ::recv(descriptor, buffer, sizeof buffer, 0);
      if (count <= 0) {
        answer.closed = count == 0;
        break;
      }
      answer.text.append(buffer, static_cast<std::size_t>(count));
    }
  }
  ::close(descriptor);
  return answer;
}

}  // namespace penumbra::server::http
