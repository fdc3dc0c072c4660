#include "server/jobs/render_service.h"

namespace penumbra::server {

nlohmann::json record_body(const RenderRecord& record) {
  return {{"id", record.id},           {"status", record.status},   {"progress", record.progress},
          {"request", record.request}, {"device", record.device},   {"error", record.error},
          {"cost", record.cost},       {"quality", record.quality}, {"notes", record.notes}};
}

}  // namespace penumbra::server
