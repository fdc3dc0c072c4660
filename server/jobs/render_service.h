#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/checkpoint.h"

namespace penumbra::server {

/// Where a render stands.
struct RenderRecord {
  std::string id;          ///< hash of the canonical request: also cache key and ETag
  std::string status;      ///< queued, running, done, failed, cancelled
  double progress = 0.0;   ///< 0..1
  nlohmann::json request;  ///< canonical, every default filled in
  nlohmann::json device;   ///< {"name","driver","type"}, null until a worker took it
  nlohmann::json error;    ///< null or {"code","message","field"}
  nlohmann::json cost;     ///< null unless measured
  nlohmann::json quality;  ///< null unless measured
  std::vector<std::string> notes;
};

/// The record as JSON (contract: GET /api/v1/renders/{id}), without the links of a front end.
nlohmann::json record_body(const RenderRecord& record);

/// Renders on worker processes with a cache of artefacts by content. Thread-safe. Knows no HTTP.
class RenderService {
 public:
  virtual ~RenderService() = default;

  /// Takes a request as the API has it (scene, technique, parameters, width, ...), checks it
  /// (throws Error: bad_value naming the field, not_found, unsupported, or `busy` when the queue is
  /// full), and answers the record: done if cached, shared if the same request is already in
  /// flight.
  virtual RenderRecord submit(const nlohmann::json& request) = 0;

  /// As it stands now; empty for an unknown id.
  virtual std::optional<RenderRecord> find(const std::string& id) = 0;

  /// Blocks until the render is over or `seconds` (steady clock) have passed.
  virtual std::optional<RenderRecord> wait(const std::string& id, double seconds) = 0;

  /// Blocks until status or progress differs from `seen` or `seconds` have passed: for event
  /// streams.
  virtual std::optional<RenderRecord> wait_change(const std::string& id, const RenderRecord& seen,
                                                  double seconds) = 0;

  /// Cancels where nobody else waits for it; false for an unknown id.
  virtual bool cancel(const std::string& id) = 0;

  /// Verified bytes of an artefact of a finished render: "image.png", "image.exr",
  /// "visibility.exr", "error.png". Made on demand where the picture exists and the artefact does
  /// not yet. Empty for an unknown id or name.
  virtual std::optional<std::string> artefact(const std::string& id, const std::string& name) = 0;

  /// Gauges for /metrics and /readyz: workers alive, queued, running, cache hits and misses, ...
  virtual nlohmann::json statistics() = 0;

  /// Stops taking requests, waits for running ones until `deadline_s`, ends the workers.
  virtual void drain(double deadline_s) = 0;
};

struct RenderServiceOptions {
  std::filesystem::path data;  ///< artefacts under data/artefacts, driver cache under data/driver
  std::string device;          ///< as RendererOptions::device
  unsigned workers = 1;
  unsigned queue_limit = 256;
  double deadline_s = 300.0;                         ///< per render
  double checkpoint_s = CheckpointFolder{}.every_s;  ///< as CheckpointFolder::every_s
  std::uint64_t cache_bytes = 4ull << 30;
  bool validation = false;
  /// Starts a worker; default is this very program with the argument `worker`.
  std::vector<std::string> worker_command;
};

std::unique_ptr<RenderService> make_render_service(const RenderServiceOptions& options);

}  // namespace penumbra::server
