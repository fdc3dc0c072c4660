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

/// A connection for bytes as they are.
class RawConnection {
 public:
  explicit RawConnection(int port) : descriptor(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) close();
  }
  ~RawConnection() { close(); }
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  /// False where the server closed.
  bool send(const std::string& bytes) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const auto count = ::send(descriptor, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return false;
      sent += static_cast<std::size_t>(count);
    }
    return true;
  }

  void stop_sending() { ::shutdown(descriptor, SHUT_WR); }
  void close() {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
  }

  /// What arrives until the server closes, `seconds` pass in silence, or `most` bytes are there.
  RawAnswer read(double seconds = 2.0, std::size_t most = SIZE_MAX) {
    const timeval patience{static_cast<long>(seconds),
                           static_cast<long>((seconds - static_cast<long>(seconds)) * 1e6)};
    ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    RawAnswer answer;
    char buffer[65536];
    while (answer.text.size() < most) {
      const auto count =
          ::recv(descriptor, buffer, std::min(sizeof buffer, most - answer.text.size()), 0);
      if (count <= 0) {
        answer.closed = count == 0;
        break;
      }
      answer.text.append(buffer, static_cast<std::size_t>(count));
    }
    return answer;
  }

  int socket() const { return descriptor; }

 private:
  int descriptor;
};

/// Sends bytes as they are and reads until the server closes or `seconds` pass in silence.
inline RawAnswer send_raw(int port, const std::string& bytes, int seconds = 2) {
  RawConnection connection(port);
  connection.send(bytes);
  return connection.read(seconds);
}

}  // namespace penumbra::server::http
