#include "server/http/serve.h"

#include <httplib.h>
#include <malloc.h>
#include <poll.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <future>
#include <iostream>
#include <thread>

#include "renderer/error.h"
#include "server/http/listener.h"
#include "server/http/operations.h"
#include "server/http/reply.h"
#include "server/http/routes.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

constexpr std::size_t most_connections = 4096;
/// Answered at once; more wait for their turn. Service::waits leaves some for short requests.
constexpr std::size_t most_requests = 512;
/// The other port is for one or two programs that watch.
constexpr std::size_t most_watchers = 64;
constexpr std::size_t watching_threads = 8;

std::size_t largest_body() {
  std::size_t largest = 0;
  for (const auto& route : routes()) largest = std::max(largest, route.largest_body);
  return largest;
}

ListenerOptions listener_options(Service& service, std::size_t threads, std::size_t connections,
                                 std::vector<std::string> methods) {
  // Files and workers need descriptors too.
  rlimit descriptors{};
  ::getrlimit(RLIMIT_NOFILE, &descriptors);
  const auto most = std::max<rlim_t>(descriptors.rlim_cur / 2, 16);
  ListenerOptions options;
  options.threads = threads;
  options.connections = std::min<std::size_t>(connections, most);
  options.refusal = [&service, methods](const Error& error, bool with_body) {
    service.metrics.count("", status_of(error.code), 0.0);
    spdlog::info("(not read) {} {}", status_of(error.code), error.what());
    return refusal_text(error, methods, with_body);
  };
  options.methods = std::move(methods);
  return options;
}

}  // namespace

struct Server::State {
  Service service;
  Listener api;
  Listener operations;
  int api_port = 0;
  int operations_port = -1;
  bool started = false;

  State(const ServeOptions& options, const MakeRenderService& make_renders)
      : service(options, make_renders),
        api(listener_options(service, most_requests, most_connections, methods_of_routes())),
        operations(listener_options(service, watching_threads, most_watchers, {"GET", "HEAD"})) {
    check_public_url(options.public_url);
    install(api, service);
    api.set_payload_max_length(largest_body());
    operations.set_payload_max_length(0);
    install_operations(operations, service);
    api_port = api.bind(options.host, options.port, "port");
    if (options.ops_port >= 0)
      operations_port = operations.bind(options.ops_host, options.ops_port, "ops_port");
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
  // Publications, sweeps and experiments first: what a drain cancels is no failure of theirs.
  state->service.publisher.stop();
  state->service.sweeps.stop();
  state->service.experiments.stop();
  auto renders = std::async(std::launch::async, [&] { state->service.renders->drain(deadline_s); });
  auto finished = std::async(std::launch::async, [&] { state->api.finish(); });
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

/// SIGTERM, SIGINT and SIGHUP become readable; a full disk or a client that left must not kill the
/// process.
void install_signals() {
  if (::pipe(signal_pipe.data()) != 0) throw Error("internal", "no pipe for signals");
  struct sigaction action {};
  action.sa_handler = note_signal;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGHUP, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

/// Every client takes a descriptor; shells allow few by default.
void raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = std::max(limit.rlim_cur, std::min<rlim_t>(limit.rlim_max, 2 * most_connections));
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// Threads come and go with connections, and glibc keeps what each has freed: with the default of
/// eight heaps a core, ten times what is in use after an hour.
void bound_heaps() {
  ::mallopt(M_ARENA_MAX, 4);
}

/// Meanwhile, memory that was freed goes back to the system now and then.
void wait_for_signal() {
  constexpr int between_ms = 30'000;
  pollfd signal{signal_pipe[0], POLLIN, 0};
  while (::poll(&signal, 1, between_ms) <= 0) ::malloc_trim(0);
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
  if (!is_local(options) && !base.starts_with("https://"))
    spdlog::warn("these addresses are not encrypted: everyone on the way reads the token");
}

}  // namespace

void log_to_standard_error() {
  spdlog::set_default_logger(spdlog::stderr_color_mt("penumbra"));
}

int serve(const ServeOptions& options) {
  log_to_standard_error();
  install_signals();
  bound_heaps();
  ::umask(0077);  // what the data folder holds is its owner's, folders within it too
  raise_descriptor_limit();
  RenderServiceOptions render_options;
  render_options.data = options.data;
  render_options.device = options.device;
  render_options.workers = options.workers;
  render_options.queue_limit = options.queue_limit;
  if (options.cache_bytes) render_options.cache_bytes = *options.cache_bytes;
  render_options.deadline_s = options.render_deadline_s;
  render_options.validation = options.validation;
  Server server(options, [&] { return make_render_service(render_options); });
  server.start();
  print_addresses(options, server);
  if (server.ops_port() > 0)
    spdlog::info("health and metrics on {}:{}", options.ops_host, server.ops_port());
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
