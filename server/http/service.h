#pragma once

#include <atomic>
#include <memory>

#include "server/http/frozen_pictures.h"
#include "server/http/frozen_study.h"
#include "server/http/guard.h"
#include "server/http/health.h"
#include "server/http/metrics.h"
#include "server/http/publisher.h"
#include "server/http/serve.h"
#include "server/http/sweeps.h"
#include "server/jobs/experiments.h"
#include "server/jobs/render_service.h"
#include "server/jobs/scene_reader.h"
#include "server/storage/data_folder.h"
#include "server/storage/database.h"
#include "server/storage/participants.h"
#include "server/storage/studies.h"

namespace penumbra::server::http {

/// Everything that handlers use. Members are destroyed in reverse: threads first, the lock last.
struct Service {
  Service(const ServeOptions& options_, const MakeRenderService& make_renders);

  ServeOptions options;
  storage::DataFolder folder;
  std::string token;  ///< the researcher's
  storage::Database database;
  storage::Studies studies;
  storage::Participants participants;
  std::unique_ptr<RenderService> renders;
  SceneReader scene_reader;
  FrozenStudies frozen;
  FrozenPictures pictures;
  Metrics metrics;
  RateLimiter failures{30, 0.5};     ///< wrong tokens and codes
  RateLimiter enrolments{120, 1};    ///< per client behind the proxy: a lab shares one address
  RateLimiter render_calls{240, 4};  ///< per client behind the proxy
  Allowance waits{384};              ///< of serve.cpp's threads
  std::atomic<bool> draining{false};
  Publisher publisher;
  Sweeps sweeps;
  Experiments experiments;
  Health health;

  /// Empty when requests can be served, otherwise why not.
  std::string not_ready();

  /// Numbers for /metrics.
  nlohmann::json gauges();
};

/// Stores the studies that the program carries in a data folder that has none of that name.
void store_shipped_studies(Service& service);

}  // namespace penumbra::server::http
