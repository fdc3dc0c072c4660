#include "server/jobs/plan_document.h"

#include "renderer/error.h"
#include "renderer/plan/plan.h"

namespace penumbra::server {
namespace {

using nlohmann::json;

/// What the technique allocates for a light, as far as its size follows from parameters alone.
std::uint64_t bytes_of(const Requirements& needs) {
  std::uint64_t bytes = 0;
  for (const MemoryNeed& need : needs.memory) bytes += need.bytes;
  return bytes;
}

json light_to_json(const Light& light, bool kept, const Requirements& needs) {
  json memory = json::array();
  for (const MemoryNeed& need : needs.memory)
    memory.push_back({{"name", need.name}, {"bytes", need.bytes}});
  return {{"light", light.name},
          {"kept", kept},
          {"stencil", needs.stencil},
          {"adjacency", needs.adjacency},
          {"acceleration_structure", needs.acceleration_structure},
          {"light_points", needs.light_points},
          {"shade_each_point", needs.shade_each_point},
          {"random_points", needs.random_points},
          {"memory", memory}};
}

}  // namespace

json plan_document(const CanonicalRequest& canonical) {
  const RenderRequest request = to_render_request(canonical);
  json document{{"scene", canonical.request.at("scene")},
                {"technique", canonical.request.at("technique")},
                {"parameters", canonical.request.at("parameters")},
                {"supported", true},
                {"reason", ""},
                {"lights", json::array()},
                {"lines", json::array()},
                {"bytes", {{"kept", 0}, {"dropped", 0}, {"technique", 0}}}};
  Plan plan;
  try {
    plan =
        make_plan(request, complete_parameters(request.technique->parameters, request.parameters),
                  instance_boxes(*request.scene));
  } catch (const Error& error) {
    if (error.code != "unsupported") throw;
    document["supported"] = false;
    document["reason"] = error.what();
    return document;
  }
  for (std::size_t i = 0; i < plan.lights.size(); ++i)
    document["lights"].push_back(
        light_to_json(request.scene->lights[i], plan.lights[i], plan.needs[i]));
  std::uint64_t kept = 0;
  std::uint64_t dropped = 0;
  std::uint64_t technique = 0;
  for (std::size_t i = 0; i < plan.lights.size(); ++i)
    if (plan.lights[i]) technique += bytes_of(plan.needs[i]);
  for (const PlanLine& line : plan.lines) {
    document["lines"].push_back({{"rule", line.rule},
                                 {"subject", line.subject},
                                 {"kept", line.kept},
                                 {"reason", line.reason},
                                 {"bytes", line.bytes}});
    (line.kept ? kept : dropped) += line.bytes;
  }
  document["bytes"] = {{"kept", kept}, {"dropped", dropped}, {"technique", technique}};
  return document;
}

}  // namespace penumbra::server
