#include "server/http/service.h"

#include <spdlog/spdlog.h>

#include "server/http/clock.h"
#include "server/http/documents.h"
#include "server/http/secrets.h"
#include "server/storage/folder_files.h"
#include "study/study.h"

namespace penumbra::server::http {
namespace {

ExperimentOptions experiment_options(const ServeOptions& options,
                                     const std::filesystem::path& data) {
  ExperimentOptions experiments;
  experiments.folder = data / "experiments";
  experiments.data = data;
  experiments.device = options.device;
  if (!options.worker_command.empty()) experiments.program = {options.worker_command.front()};
  return experiments;
}

}  // namespace

Service::Service(const ServeOptions& options_, const MakeRenderService& make_renders)
    : options(options_),
      folder(options.data),
      token(researcher_token(options.token_file.empty() ? folder.path() / storage::token_name
                                                        : options.token_file)),
      database(folder.path() / storage::database_name),
      studies(database),
      participants(database),
      renders(make_renders()),
      scene_reader({options.worker_command, 0, options.import_deadline_s}),
      frozen(studies),
      pictures(studies, *renders, folder.path()),
      publisher(studies, *renders, pictures),
      sweeps(database, *renders),
      experiments(experiment_options(options, folder.path())),
      health(folder, database, pictures) {
  storage::sweep_leftovers(folder.path());
}

std::string Service::not_ready() {
  if (draining) return "draining";
  if (const std::string trouble = renders->trouble(); !trouble.empty()) return trouble;
  return health.trouble();
}

nlohmann::json Service::gauges() {
  nlohmann::json numbers = {{"renders", renders->statistics()},
                            {"sweeps", sweeps.statistics()},
                            {"scene_reader", scene_reader.statistics()},
                            {"ready", not_ready().empty()},
                            {"storage",
                             {{"failures", database.failures()},
                              {"wal_bytes", database.log_bytes()},
                              {"damaged_rows", database.damage().size()},
                              {"damaged_pictures", pictures.damaged()}}},
                            {"participants", nlohmann::json::object()}};
  if (!database.healthy()) return numbers;
  for (const auto& record : studies.list()) {
    const auto counts = studies.counts(record.id, record.version);
    auto& total = numbers["participants"];
    total["entered"] = total.value("entered", 0) + counts.entered;
    total["completed"] = total.value("completed", 0) + counts.completed;
  }
  return numbers;
}

void store_shipped_studies(Service& service) {
  if (!service.database.healthy()) return;
  for (const auto& file : embedded_studies()) {
    const auto study = study::parse_study(std::string(file.text));
    if (service.studies.current(study.id)) continue;
    service.studies.put_draft(study.id, study.document, random_seed(), utc_now());
  }
}

}  // namespace penumbra::server::http
