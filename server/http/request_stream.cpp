#include "server/http/request_stream.h"

#include <arpa/inet.h>
#include <linux/sockios.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace penumbra::server::http {
namespace {

constexpr std::size_t body_block = 64 << 10;  // bytes received at once
constexpr int glance_ms = 250;                // between two looks at what else happened

thread_local RequestStream* of_this_thread = nullptr;

void read_end(const sockaddr_storage& address, std::string& text, int& port) {
  char buffer[INET6_ADDRSTRLEN] = {};
  if (address.ss_family == AF_INET) {
    const auto& four = reinterpret_cast<const sockaddr_in&>(address);
    ::inet_ntop(AF_INET, &four.sin_addr, buffer, sizeof buffer);
    port = ntohs(four.sin_port);
  } else if (address.ss_family == AF_INET6) {
    const auto& six = reinterpret_cast<const sockaddr_in6&>(address);
    ::inet_ntop(AF_INET6, &six.sin6_addr, buffer, sizeof buffer);
    port = ntohs(six.sin6_port);
  }
  text = buffer;
}

/// True where a program of this machine (nginx is one) only ended its sending by the connection
/// between these ports. Its socket then still has an owner, which Linux tells by an inode that is
/// not zero (proc(5)). Of other machines nothing more is known than that they send no more.
bool still_reads(int from_port, int to_port) {
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(table);
    std::string line;
    while (std::getline(file, line)) {
      std::istringstream words(line);
      std::vector<std::string> word(10);
      for (auto& each : word) words >> each;
      const auto port = [](const std::string& end) {
        const auto colon = end.find(':');
        return colon == std::string::npos ? -1 : std::stoi(end.substr(colon + 1), nullptr, 16);
      };
      constexpr std::size_t local = 1, remote = 2, inode = 9;
      if (word[inode] != "0" && port(word[local]) == from_port && port(word[remote]) == to_port)
        return true;
    }
  }
  return false;
}

/// The head without `Expect`: the stream itself tells the client to go on, once somebody reads.
std::string head_for_library(const std::string& input, const RequestHead& head) {
  std::string text = input.substr(0, head.size);
  if (!head.expects_continue) return text;
  for (auto start = text.find("\r\n") + 2; start < text.size();) {
    const auto end = text.find("\r\n", start) + 2;
    if (::strncasecmp(text.c_str() + start, "Expect:", 7) == 0)
      return text.erase(start, end - start);
    start = end;
  }
  return text;
}

}  // namespace

RequestStream::RequestStream(Connection& connection_, const std::atomic<bool>& stopping_)
    : connection(connection_),
      stopping(stopping_),
      with_body(connection.limits),
      with_reader(connection.limits) {
  const auto head = head_for_library(connection.input, connection.head);
  connection.input.replace(0, connection.head.size, head);
  connection.framed -= connection.head.size - head.size();
  of_this_thread = this;
}

RequestStream::~RequestStream() {
  of_this_thread = nullptr;
}

RequestStream& RequestStream::current() {
  if (of_this_thread == nullptr) throw std::logic_error("this thread answers no request");
  return *of_this_thread;
}

bool RequestStream::closed_by_peer() const {
  char byte = 0;
  if (::recv(connection.descriptor, &byte, 1, MSG_PEEK | MSG_DONTWAIT) != 0) return false;
  std::string address;
  int here = 0;
  int there = 0;
  get_local_ip_and_port(address, here);
  get_remote_ip_and_port(address, there);
  return !still_reads(there, here);
}

void RequestStream::finish_head(httplib::Response& response) {
  response.headers.erase("Keep-Alive");  // what it promises is the library's, not the listener's
  closing = response.get_header_value("Connection") == "close";
  if (closing || (understood && connection.framing.done())) return;
  closing = true;
  response.set_header("Connection", "close");
}

ssize_t RequestStream::read(char* into, std::size_t size) {
  if (position == connection.framed && !receive()) return connection.framing.done() ? 0 : -1;
  const auto count = std::min(size, connection.framed - position);
  std::memcpy(into, connection.input.data() + position, count);
  position += count;
  return static_cast<ssize_t>(count);
}

bool RequestStream::receive() {
  auto& framing = connection.framing;
  if (framing.done() || framing.broken() || failed) return false;
  connection.tell_to_continue();
  std::array<char, body_block> bytes;
  auto last = Connection::Clock::now();
  while (true) {
    const auto count = ::recv(connection.descriptor, bytes.data(), bytes.size(), MSG_DONTWAIT);
    const int failure = errno;
    const auto now = Connection::Clock::now();
    if (!with_body.spend(now - last, std::max(0.0, static_cast<double>(count)))) break;
    last = now;
    if (count > 0) {
      connection.input.assign(bytes.data(), static_cast<std::size_t>(count));
      position = 0;
      connection.framed = framing.take(connection.input);
      return connection.framed > 0;
    }
    if (count == 0 || (failure != EAGAIN && failure != EWOULDBLOCK && failure != EINTR)) break;
    pollfd wait{connection.descriptor, POLLIN, 0};
    if (::poll(&wait, 1, glance_ms) == 0 && stopping) break;
  }
  failed = true;
  return false;
}

bool RequestStream::wait_until_writable() {
  const auto start = Connection::Clock::now();
  pollfd wait{connection.descriptor, POLLOUT, 0};
  ::poll(&wait, 1, glance_ms);
  // The system says late that there is room again, so what the client took is asked for.
  int unsent = 0;
  ::ioctl(connection.descriptor, SIOCOUTQ, &unsent);
  const double before = taken;
  taken = sent - unsent;
  return with_reader.spend(Connection::Clock::now() - start, taken - before);
}

ssize_t RequestStream::write(const char* bytes, std::size_t size) {
  std::size_t done = 0;
  while (done < size && !failed) {
    const auto count =
        ::send(connection.descriptor, bytes + done, size - done, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
      sent += static_cast<double>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      failed = !wait_until_writable();
    } else if (errno != EINTR) {
      failed = true;
    }
  }
  return failed ? -1 : static_cast<ssize_t>(size);
}

void RequestStream::get_remote_ip_and_port(std::string& address, int& port) const {
  sockaddr_storage end{};
  socklen_t size = sizeof end;
  if (::getpeername(connection.descriptor, reinterpret_cast<sockaddr*>(&end), &size) == 0)
    read_end(end, address, port);
}

void RequestStream::get_local_ip_and_port(std::string& address, int& port) const {
  sockaddr_storage end{};
  socklen_t size = sizeof end;
  if (::getsockname(connection.descriptor, reinterpret_cast<sockaddr*>(&end), &size) == 0)
    read_end(end, address, port);
}

}  // namespace penumbra::server::http
