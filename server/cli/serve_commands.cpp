#include "server/cli/session.h"
#include "server/http/serve.h"
#include "server/jobs/worker.h"

namespace penumbra::server::cli {
namespace {

void add_serve(CLI::App& app, Session& session) {
  auto options = std::make_shared<http::ServeOptions>();
  CLI::App* serve = app.add_subcommand("serve", "Answer HTTP: renders, studies, results");
  serve->add_option("--host", options->host, "Address to listen on")->capture_default_str();
  serve->add_option("--port", options->port, "Port, 0 for a free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  serve->add_option("--ops-host", options->ops_host, "Address of health and metrics")
      ->capture_default_str();
  serve->add_option("--ops-port", options->ops_port, "Port of health and metrics, -1 for none")
      ->check(CLI::Range(-1, 65535))
      ->capture_default_str();
  serve->add_option("--data", options->data, "Folder of everything the server keeps")
      ->capture_default_str();
  serve->add_option("--workers", options->workers, "Processes that draw")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  serve->add_option("--device", options->device, "Vulkan device: part of its name, or its index");
  serve->add_option(
      "--token-file", options->token_file,
      "File with the researcher's token; by default one in the data folder, made once");
  serve->add_option("--web", options->web, "Serve the pages from this folder");
  serve->add_option(
      "--public-url", options->public_url,
      "How browsers reach this server; with it, or a host that is not loopback, renders need "
      "the researcher's token");
  serve->add_option("--queue-limit", options->queue_limit, "Renders that may wait")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  serve->add_option("--cache-bytes", options->cache_bytes, "Disk for pictures; the oldest go first")
      ->check(CLI::Range(std::uint64_t{1} << 20, std::uint64_t{1} << 50));
  serve->add_option("--render-deadline", options->render_deadline_s, "Seconds per render")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  serve->add_option("--import-deadline", options->import_deadline_s, "Seconds per uploaded scene")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  serve
      ->add_option("--drain-deadline", options->drain_deadline_s,
                   "Seconds for running work after SIGTERM")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  serve->add_flag("--validation", options->validation, "Turn Vulkan's validation layer on");
  serve->callback(
      [options, &session] { session.action = [options] { return http::serve(*options); }; });
}

void add_worker(CLI::App& app, Session& session) {
  auto options = std::make_shared<WorkerOptions>();
  CLI::App* worker = app.add_subcommand(
      "worker", "Draw what a server asks for on standard input (started by serve)");
  worker->add_option("--data", options->data, "Folder of imported scenes");
  worker->add_option("--device", options->device, "Vulkan device: part of its name, or its index");
  worker->add_option("--memory-limit", options->memory_limit,
                     "Address space that drawing may add, bytes; 0: the machine's memory");
  worker->add_option("--read-scene", options->read_scene,
                     "Only read this scene file and say what it is");
  worker->add_option("--read-picture", options->read_picture,
                     "Only read this picture and write it as PNG");
  worker->add_option("--checkpoint-s", options->checkpoint_s,
                     "Least time between two checkpoints of a picture, seconds");
  worker->add_flag("--validation", options->validation, "Turn Vulkan's validation layer on");
  worker->callback(
      [options, &session] { session.action = [options] { return run_worker(*options); }; });
}

}  // namespace

void add_serve_commands(CLI::App& app, Session& session) {
  add_serve(app, session);
  add_worker(app, session);
}

}  // namespace penumbra::server::cli
