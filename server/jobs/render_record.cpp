#include "server/jobs/render_service.h"

namespace penumbra::server {

nlohmann::json record_body(const RenderRecord& record) {
  return {{"id", record.id},           {"status", record.status},   {"progress", record.progress},
          {"request", record.request}, {"device", record.device},   {"error", record.error},
          {"cost", record.cost},       {"quality", record.quality}, {"notes", record.notes}};
}

bool is_over(const RenderRecord& record) {
  return record.status != "queued" && record.status != "running";
}

Error failure_of(const RenderRecord& record) {
  if (!record.error.is_object()) return {"cancelled", "the render is " + record.status};
  return {record.error.value("code", "internal"), record.error.value("message", ""),
          record.error.value("field", "")};
}

SharedBytes RenderService::artefact(const std::string& id, const std::string& name,
                                    const Submitter& who) {
  constexpr double look_s = 60.0;
  if (SharedBytes bytes = stored_artefact(id, name)) return bytes;
  auto record = submit_artefact(id, name, who);
  while (record && !is_over(*record)) record = wait(id, look_s);
  if (!record) return nullptr;
  if (record->status != "done") throw failure_of(*record);
  return stored_artefact(id, name);
}

}  // namespace penumbra::server
