#include "experiments/recommend/savings.h"

#include <algorithm>
#include <cmath>

#include "experiments/report/rows.h"
#include "renderer/plan/plan.h"
#include "renderer/scene/light.h"

namespace penumbra::experiments::recommend {
namespace {

using nlohmann::json;

/// A saving of time below this share of the frame is within what times scatter by.
constexpr double least_saving = 0.03;

struct Before {
  double ms;
  double bytes;
  double error;
  double bound;  ///< of error
};

json saving(const std::string& what, const std::string& why, const Before& before,
            const json& row) {
  const double ms = number_of(row, "frame_ms"), error = number_of(row, "visibility_rms");
  const double saved_bytes = before.bytes - number_of(row, "memory_bytes");
  const bool harmless = error <= before.bound;
  return {
      {"what", what},
      {"why", why},
      {"frame_ms", ms},
      {"saved_ms", before.ms - ms},
      {"saved_bytes", saved_bytes},
      {"error", error},
      {"error_before", before.error},
      {"worth_it", harmless && (saved_bytes > 0.0 || before.ms - ms > least_saving * before.ms)},
      {"taken", false}};
}

/// Halves the map until the error passes its bound, the map's least or what the device takes.
void add_smaller_maps(json& list, const Run& pick, const Before& before,
                      const std::function<json(const Run&)>& measure) {
  const auto resolved = techniques::resolve(pick.technique, pick.parameters);
  const auto& declared = resolved.technique->parameters;
  const auto map = std::find_if(declared.begin(), declared.end(),
                                [](const Parameter& p) { return p.name == "map_size"; });
  if (map == declared.end()) return;
  Run run = pick;
  std::int64_t size = integer_of(resolved.parameters, map->name);
  while (static_cast<double>(size / 2) >= map->minimum) {
    size /= 2;
    run.parameters[map->name] = size;
    run.name = pick.technique + ", " + map->name + " " + std::to_string(size);
    const json row = measure(run);
    if (!is_done(row)) return;
    list.push_back(saving(map->name + "=" + std::to_string(size), "texels that pixels do not show",
                          before, row));
    if (number_of(row, "visibility_rms") > before.bound) return;
  }
}

void add_hard_lights(json& list, const Scene& scene, const Run& pick, const Before& before,
                     const std::function<json(const Run&)>& measure) {
  for (const Light& light : scene.lights) {
    if (!has_extent(light)) continue;
    Run run = pick;
    run.hard_lights = {light.name};
    run.name = pick.name + ", " + light.name + " hard";
    const json row = measure(run);
    if (is_done(row))
      list.push_back(saving("light " + light.name + " without extent",
                            "its penumbrae against what they cost", before, row));
  }
}

/// What the plan leaves out, and what drawing it would cost.
void add_idle_casters(json& list, RenderRequest request, const Run& pick, const Before& before,
                      const std::function<json(const Run&)>& measure) {
  const auto boxes = instance_boxes(*request.scene);
  const Plan with = make_plan(request, request.parameters, boxes);
  std::size_t idle = 0;
  for (std::size_t i = 0; i < with.instances.size(); ++i)
    if (!with.instances[i].casts && request.scene->instances[i].casts_shadow) ++idle;
  if (idle == 0) return;
  request.rules.casters = false;
  const auto kept_bytes = [](const Plan& plan) {
    double sum = 0.0;
    for (const PlanLine& line : plan.lines)
      sum += line.kept ? static_cast<double>(line.bytes) : 0.0;
    return sum;
  };
  const double bytes = kept_bytes(make_plan(request, request.parameters, boxes)) - kept_bytes(with);
  Run run = pick;
  run.idle_casters = true;
  run.name = pick.name + ", all casters";
  const json row = measure(run);
  if (!is_done(row)) return;
  list.push_back({{"what", std::to_string(idle) + " casters that shadow nothing visible"},
                  {"why", "left out by the plan of every render"},
                  {"frame_ms", before.ms},
                  {"saved_ms", number_of(row, "frame_ms") - before.ms},
                  {"saved_bytes", bytes},
                  {"error", before.error},
                  {"error_before", before.error},
                  {"worth_it", true},
                  {"taken", true}});
}

}  // namespace

json savings(Engine& engine, const Run& pick, const std::function<json(const Run&)>& measure) {
  const json row = measure(pick);
  const double error = number_of(row, "visibility_rms");
  const Before before{number_of(row, "frame_ms"), number_of(row, "memory_bytes"), error,
                      std::max((1.0 + granted_share) * error, error + granted_least)};
  json list = json::array();
  add_smaller_maps(list, pick, before, measure);
  const RenderRequest request = engine.request_of(pick);
  add_hard_lights(list, *request.scene, pick, before, measure);
  add_idle_casters(list, request, pick, before, measure);
  return list;
}

}  // namespace penumbra::experiments::recommend
