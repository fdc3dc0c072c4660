#include "server/http/listener.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "server/http/request_stream.h"

namespace penumbra::server::http {
namespace {

constexpr int tick_ms = 200;  // between two looks for clients that are late
/// A client that goes on at once keeps its thread: handing it over costs more than waiting.
constexpr int stay_ms = 2;

}  // namespace

Listener::Listener(ListenerOptions options_) : options(std::move(options_)) {
  poller = ::epoll_create1(EPOLL_CLOEXEC);
  waker = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (poller < 0 || waker < 0) throw Error("storage", "no descriptors left");
  set_post_routing_handler([](const httplib::Request&, httplib::Response& response) {
    RequestStream::current().finish_head(response);
  });
}

Listener::~Listener() {
  finish();
  if (svr_sock_ != INVALID_SOCKET) ::close(svr_sock_.exchange(INVALID_SOCKET));
  ::close(poller);
  ::close(waker);
}

int Listener::bind(const std::string& host, int port, const char* field) {
  // The library's own options would let two processes share a port.
  set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  const int bound = port == 0 ? bind_to_any_port(host) : bind_to_port(host, port) ? port : -1;
  if (bound <= 0)
    throw Error("conflict", "cannot listen on " + host + ":" + std::to_string(port), field);
  ::listen(svr_sock_, SOMAXCONN);
  return bound;
}

void Listener::start() {
  ::fcntl(svr_sock_, F_SETFL, ::fcntl(svr_sock_, F_GETFL) | O_NONBLOCK);
  for (const int descriptor : {static_cast<int>(svr_sock_), waker}) {
    epoll_event event{EPOLLIN, {}};
    event.data.fd = descriptor;
    ::epoll_ctl(poller, EPOLL_CTL_ADD, descriptor, &event);
  }
  queue = std::make_unique<ElasticTaskQueue>(options.threads);
  thread = std::thread([this] { run(); });
}

void Listener::finish() {
  if (!thread.joinable()) return;
  stopping = true;
  wake();
  thread.join();
  queue->shutdown();
  // Only now: answers that are made piece by piece break off once the library sees it closed.
  ::close(svr_sock_.exchange(INVALID_SOCKET));
  returned.clear();
}

void Listener::wake() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(waker, &one, sizeof one);
}

void Listener::run() {
  std::array<epoll_event, 256> events;
  auto next_tick = Clock::now();
  while (!stopping) {
    const int count = ::epoll_wait(poller, events.data(), events.size(), tick_ms);
    for (int i = 0; i < count; ++i) {
      const int descriptor = events[static_cast<std::size_t>(i)].data.fd;
      if (descriptor == svr_sock_)
        accept_some();
      else if (descriptor == waker)
        take_back();
      else if (const auto found = waiting.find(descriptor); found != waiting.end())
        advance(take(found));
    }
    if (Clock::now() < next_tick) continue;
    end_late_ones();
    next_tick = Clock::now() + std::chrono::milliseconds(tick_ms);
  }
  ::epoll_ctl(poller, EPOLL_CTL_DEL, svr_sock_, nullptr);
  ::shutdown(svr_sock_, SHUT_RDWR);
  waiting.clear();
}

void Listener::accept_some() {
  constexpr int most = 64;  // before those that are there have their turn
  for (int i = 0; i < most; ++i) {
    const int descriptor = ::accept4(svr_sock_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (descriptor < 0) {
      // The system goes on telling that somebody knocks while no descriptor is free.
      if ((errno == EMFILE || errno == ENFILE) && !make_room())
        std::this_thread::sleep_for(std::chrono::milliseconds(tick_ms));
      return;
    }
    auto connection = std::make_unique<Connection>(descriptor, options.limits);
    const int yes = 1;
    ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    epoll_event event{EPOLLONESHOT, {}};
    event.data.fd = descriptor;
    ::epoll_ctl(poller, EPOLL_CTL_ADD, descriptor, &event);
    if (waiting.size() + running >= options.connections && !make_room())
      refuse(std::move(connection), Error("busy", "too many connections"));
    else
      advance(std::move(connection));
  }
}

/// Ends the connection that has waited longest for its client. False where none waits.
bool Listener::make_room() {
  const auto longest =
      std::min_element(waiting.begin(), waiting.end(), [](const auto& a, const auto& b) {
        return a.second->waiting_since() < b.second->waiting_since();
      });
  if (longest == waiting.end()) return false;
  take(longest);
  return true;
}

void Listener::advance(Owned connection) {
  if (connection->parted()) {
    if (connection->drop_rest()) keep(std::move(connection));
    return;
  }
  switch (connection->receive(options.methods)) {
    case Connection::State::ready:
      return hand_out(std::move(connection));
    case Connection::State::waiting:
      return keep(std::move(connection));
    case Connection::State::refused: {
      const Error reason = connection->refusal();
      return refuse(std::move(connection), reason);
    }
    case Connection::State::gone:
      return;
  }
}

void Listener::keep(Owned connection) {
  const int descriptor = connection->socket();
  epoll_event event{EPOLLIN | EPOLLONESHOT, {}};
  event.data.fd = descriptor;
  if (::epoll_ctl(poller, EPOLL_CTL_MOD, descriptor, &event) != 0) return;
  buffered += connection->buffered();
  waiting[descriptor] = std::move(connection);
  if (buffered <= options.buffered) return;
  take(std::max_element(waiting.begin(), waiting.end(), [](const auto& a, const auto& b) {
    return a.second->buffered() < b.second->buffered();
  }));
}

Listener::Owned Listener::take(std::map<int, Owned>::iterator entry) {
  auto connection = std::move(entry->second);
  waiting.erase(entry);
  buffered -= connection->buffered();
  return connection;
}

void Listener::refuse(Owned connection, const Error& reason) {
  connection->part(options.refusal(reason, connection->request().method != "HEAD"));
  if (connection->drop_rest()) keep(std::move(connection));
}

void Listener::hand_out(Owned connection) {
  ++running;
  const auto bytes = connection->buffered();
  buffered += bytes;
  queue->enqueue([this, bytes, shared = std::make_shared<Owned>(std::move(connection))] {
    answer(std::move(*shared));
    buffered -= bytes;
    --running;
  });
}

void Listener::take_back() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto bytes = ::read(waker, &count, sizeof count);
  std::vector<Owned> back;
  {
    const std::lock_guard lock(mutex);
    back.swap(returned);
  }
  for (auto& connection : back) advance(std::move(connection));
}

void Listener::end_late_ones() {
  const auto now = Clock::now();
  std::vector<int> late;
  for (const auto& [descriptor, connection] : waiting)
    if (connection->deadline() <= now) late.push_back(descriptor);
  for (const int descriptor : late) {
    auto connection = take(waiting.find(descriptor));
    if (!connection->parted() && !connection->idle())
      refuse(std::move(connection), Error("too_slow", "the request did not come in time"));
  }
}

void Listener::answer(Owned connection) {
  auto state = Connection::State::ready;
  while (state == Connection::State::ready) {
    if (!answer_one(*connection)) {
      if (connection->all_used()) return;
      connection->part({});
      break;
    }
    state = next_request(*connection);
  }
  if (state == Connection::State::gone) return;
  {
    const std::lock_guard lock(mutex);
    returned.push_back(std::move(connection));
  }
  wake();
}

bool Listener::answer_one(Connection& connection) {
  RequestStream stream(connection, stopping);
  bool closed = false;
  try {
    const bool answered =
        process_request(stream, stopping || !connection.request().keeps_alive, closed,
                        [&](httplib::Request&) { stream.set_understood(); });
    return answered && !closed && stream.reusable();
  } catch (const std::exception& error) {
    spdlog::error("a request failed outside of its handler: {}", error.what());
    return false;
  }
}

Connection::State Listener::next_request(Connection& connection) {
  connection.next();
  if (stopping) return Connection::State::gone;
  auto state = connection.receive(options.methods);
  if (state != Connection::State::waiting || running > options.threads / 2) return state;
  pollfd wait{connection.socket(), POLLIN, 0};
  return ::poll(&wait, 1, stay_ms) > 0 ? connection.receive(options.methods) : state;
}

}  // namespace penumbra::server::http
