#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "renderer/error.h"
#include "server/jobs/checkpoint.h"

namespace penumbra::server {

/// How far a render is.
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

/// Neither queued nor running.
bool is_over(const RenderRecord& record);

/// Why a render that is over has no picture.
Error failure_of(const RenderRecord& record);

/// Whose renders come first; a higher one goes before all lower ones.
enum class Priority { anonymous, researcher, publication };

/// Who asks for a render. It is drawn as long as one of its submitters has not released it.
struct Submitter {
  Priority priority = Priority::researcher;
  std::string client;  ///< renders of one priority are taken from clients in turn
  /// Each of them releases what this submitter asked for, so they are its secrets. Asking again
  /// with any of the same keys is one submission.
  std::set<std::string> keys = {""};
  std::set<std::string> further_keys;  ///< of those who may end what others asked for
};

using SharedBytes = std::shared_ptr<const std::string>;

/// Renders on worker processes with a cache of artefacts by content. Thread-safe. Knows no HTTP.
class RenderService {
 public:
  virtual ~RenderService() = default;

  /// Takes a request as the API has it (scene, technique, parameters, width, ...), checks it
  /// (throws Error: bad_value naming the field, not_found, unsupported where the device cannot hold
  /// it or it ended two workers, or `busy` when the queue is full or nothing can be drawn), and
  /// returns the record: done if cached, shared if the same request is already in flight.
  virtual RenderRecord submit(const nlohmann::json& request, const Submitter& who = {}) = 0;

  /// Throws what `submit` would for a request that says something wrong; draws nothing.
  virtual void check(const nlohmann::json& request) = 0;

  /// As it is now; empty for an unknown id.
  virtual std::optional<RenderRecord> find(const std::string& id) = 0;

  /// Blocks until the render is over or `seconds` (steady clock) have passed.
  virtual std::optional<RenderRecord> wait(const std::string& id, double seconds) = 0;

  /// Blocks until status or progress differs from `seen` or `seconds` have passed: for event
  /// streams.
  virtual std::optional<RenderRecord> wait_change(const std::string& id, const RenderRecord& seen,
                                                  double seconds) = 0;

  /// Drops the submissions that hold one of `keys`; what no submission wants any more is cancelled.
  /// False where there is no such submission: the render is over, or it is others'.
  virtual bool release(const std::string& id, const std::set<std::string>& keys) = 0;

  /// Verified bytes of an artefact that is stored: "image.png", "image.exr", "visibility.exr",
  /// "error.png". All callers share one copy. Null where it is not there.
  virtual SharedBytes stored_artefact(const std::string& id, const std::string& name) = 0;

  /// Has an artefact made that a finished render lacks. Empty for an unknown id or name.
  virtual std::optional<RenderRecord> submit_artefact(const std::string& id,
                                                      const std::string& name,
                                                      const Submitter& who) = 0;

  /// The artefact, made where it is not stored; blocks until then. Null for an unknown id or name;
  /// throws the render's error.
  SharedBytes artefact(const std::string& id, const std::string& name, const Submitter& who = {});

  /// Why nothing can be drawn at the moment, or empty.
  virtual std::string trouble() = 0;

  /// Gauges for /metrics and /readyz: workers alive, queued, running, cache hits and misses, ...
  virtual nlohmann::json statistics() = 0;

  /// Stops taking requests, waits for running ones until `deadline_s`, ends the workers.
  virtual void drain(double deadline_s) = 0;
};

struct RenderServiceOptions {
  std::filesystem::path data;  ///< artefacts under data/artefacts, driver cache under data/driver
  std::string device;          ///< as RendererOptions::device
  unsigned workers = 1;
  unsigned queue_limit = 256;                        ///< renders that may wait, of each priority
  double deadline_s = 300.0;                         ///< per render
  double checkpoint_s = CheckpointFolder{}.every_s;  ///< as CheckpointFolder::every_s
  /// A worker that has drawn and then rested for so long gives way to a fresh one: drivers keep
  /// much of what pictures took.
  double fresh_after_s = 300.0;
  std::uint64_t cache_bytes = 4ull << 30;
  bool validation = false;
  /// Starts a worker; default is this very program with the argument `worker`.
  std::vector<std::string> worker_command;
};

std::unique_ptr<RenderService> make_render_service(const RenderServiceOptions& options);

}  // namespace penumbra::server
