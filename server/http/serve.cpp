#include "server/http/serve.h"

#include <httplib.h>
#include <netinet/in.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <future>
#include <iostream>
#include <thread>

#include "renderer/error.h"
#include "server/http/connection.h"
#include "server/http/operations.h"
#include "server/http/reply.h"
#include "server/http/routes.h"
#include "server/http/service.h"
#include "server/http/task_queue.h"

namespace penumbra::server::http {
namespace {

constexpr std::size_t most_connections = 600;  // served at once; more wait for their turn

/// The library listens with a queue of five connections and lets two processes share a port.
class Listener : public httplib::Server {
 public:
  int bind(const std::string& host, int port, const char* field) {
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

  void start() {
    thread = std::thread([this] { listen_after_bind(); });
    while (!is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  /// Accepts nothing new and waits for what runs.
  void finish() {
    stop();
    if (thread.joinable()) thread.join();
  }

 private:
  std::thread thread;
};

}  // namespace

struct Server::State {
  Service service;
  Listener api;
  Listener operations;
  int api_port = 0;
  int operations_port = -1;
  bool started = false;

  State(const ServeOptions& options, const MakeRenderService& make_renders)
      : service(options, make_renders) {
    api.new_task_queue = [] { return new ElasticTaskQueue(most_connections); };
    api.set_keep_alive_max_count(100000);
    api.set_keep_alive_timeout(15);
    api.set_read_timeout(10);
    api.set_write_timeout(20);
    api.set_tcp_nodelay(true);
    install(api, service);
    install_operations(operations, service);
    api_port = api.bind(options.host, options.port, "port");
    if (options.ops_port >= 0)
      operations_port = operations.bind(options.host, options.ops_port, "ops_port");
  }
};

Server::Server(const ServeOptions& options, const MakeRenderService& make_renders)
    : state(std::make_unique<State>(options, make_renders)) {}

Server::~Server() {
  if (state->started) stop(0.0);
}

void Server::start() {
  store_shipped_studies(state->service);
  if (state->service.database.healthy()) state->service.publisher.resume();
  if (state->operations_port > 0) state->operations.start();
  state->api.start();
  state->started = true;
}

bool Server::stop(double deadline_s) {
  if (!state->started) return true;
  state->started = false;
  state->service.draining = true;
  // Publications and sweeps first: what a drain cancels is no failure of theirs.
  state->service.publisher.stop();
  state->service.sweeps.stop();
  auto renders = std::async(std::launch::async, [&] { state->service.renders->drain(deadline_s); });
  auto finished = std::async(std::launch::async, [&] { state->api.finish(); });
  // Connections that stay open without a request would be waited for as long as they may idle.
  if (finished.wait_for(std::chrono::seconds(1)) != std::future_status::ready)
    shut_reading(state->api_port);
  const bool all =
      finished.wait_for(std::chrono::duration<double>(deadline_s)) == std::future_status::ready;
  finished.get();
  renders.get();
  if (state->operations_port > 0) state->operations.finish();
  return all;
}

int Server::port() const {
  return state->api_port;
}
int Server::ops_port() const {
  return state->operations_port;
}
const std::string& Server::token() const {
  return state->service.token;
}

namespace {

std::array<int, 2> signal_pipe{-1, -1};

void note_signal(int) {
  const char byte = 1;
  [[maybe_unused]] const auto written = ::write(signal_pipe[1], &byte, 1);
}

/// SIGTERM and SIGINT become readable; a full disk or a client that left must not kill the process.
void install_signals() {
  if (::pipe(signal_pipe.data()) != 0) throw Error("internal", "no pipe for signals");
  struct sigaction action {};
  action.sa_handler = note_signal;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void wait_for_signal() {
  char byte = 0;
  while (::read(signal_pipe[0], &byte, 1) < 0 && errno == EINTR) {
  }
}

void print_addresses(const ServeOptions& options, const Server& server) {
  const std::string host =
      options.host.find(':') != std::string::npos ? "[" + options.host + "]" : options.host;
  std::string base = options.public_url.empty()
                         ? "http://" + host + ":" + std::to_string(server.port())
                         : options.public_url;
  while (base.ends_with('/')) base.pop_back();
  std::cout << "Participants: " << base << "/s/thesis-2007\n"
            << "Researchers:  " << base << "/lab?token=" << server.token() << std::endl;
}

}  // namespace

int serve(const ServeOptions& options) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("penumbra"));
  install_signals();
  RenderServiceOptions render_options;
  render_options.data = options.data;
  render_options.device = options.device;
  render_options.workers = options.workers;
  render_options.queue_limit = options.queue_limit;
  render_options.deadline_s = options.render_deadline_s;
  render_options.validation = options.validation;
  Server server(options, [&] { return make_render_service(render_options); });
  server.start();
  print_addresses(options, server);
  if (server.ops_port() > 0) spdlog::info("health and metrics on port {}", server.ops_port());
  wait_for_signal();
  spdlog::info("stopping; running requests have {} s", options.drain_deadline_s);
  auto stopped =
      std::async(std::launch::async, [&] { return server.stop(options.drain_deadline_s); });
  constexpr double grace_s = 5.0;
  const auto limit = std::chrono::duration<double>(options.drain_deadline_s + grace_s);
  if (stopped.wait_for(limit) != std::future_status::ready) {
    // Everything acknowledged is on disk; who still holds a connection open is not waited for.
    spdlog::warn("some requests did not finish in time");
    spdlog::shutdown();
    std::_Exit(0);
  }
  return 0;
}

}  // namespace penumbra::server::http
