#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::server {
class RenderService;
}

namespace penumbra::server::http {

struct ServeOptions {
  std::string host = "127.0.0.1";
  int port = 8080;  ///< 0 picks a free one, which is printed
  std::string ops_host = "127.0.0.1";
  int ops_port = 8081;  ///< /healthz /readyz /metrics; 0 picks a free one, below 0: none
  std::filesystem::path data = "data";
  std::string device;  ///< as RendererOptions::device
  unsigned workers = 1;
  std::filesystem::path
      token_file;              ///< researcher's token; empty: data/researcher.token, made once
  std::filesystem::path web;   ///< serve the pages from this folder instead of the built-in ones
  std::string public_url;      ///< how browsers reach the server, e.g. https://study.example.org
  unsigned queue_limit = 256;  ///< renders that may wait
  std::optional<std::uint64_t> cache_bytes;  ///< as RenderServiceOptions::cache_bytes
  double render_deadline_s = 300.0;
  double import_deadline_s = 60.0;          ///< per uploaded scene
  std::vector<std::string> worker_command;  ///< of the process that reads them; empty: this program
  double drain_deadline_s = 30.0;           ///< after SIGTERM
  bool validation = false;
};

/// Called once the data folder is locked: nothing may touch it before.
using MakeRenderService = std::function<std::unique_ptr<RenderService>()>;

/// The running server, for embedding and tests: `serve` adds the render service and the signals.
class Server {
 public:
  /// Locks the data folder, opens the database, binds both ports. Throws Error: bad_value naming
  /// `host` or `port`, conflict where another process owns the folder or the port.
  Server(const ServeOptions& options, const MakeRenderService& make_renders);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Answers requests on threads of its own until `stop`.
  void start();

  /// Not ready any more; running requests finish within `deadline_s`. True where all did.
  bool stop(double deadline_s);

  int port() const;
  int ops_port() const;
  const std::string& token() const;  ///< the researcher's

 private:
  struct State;
  std::unique_ptr<State> state;
};

/// Logs go to standard error, so that standard output holds the one document that was asked for.
void log_to_standard_error();

/// `penumbra serve`: prints the participant's and the researcher's URLs and answers until SIGTERM
/// or SIGINT. Returns the process's exit status.
int serve(const ServeOptions& options);

}  // namespace penumbra::server::http
