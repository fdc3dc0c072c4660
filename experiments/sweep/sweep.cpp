#include "experiments/sweep/sweep.h"

#include <algorithm>
#include <set>

#include "experiments/report/rows.h"
#include "experiments/sweep/grid.h"
#include "experiments/sweep/limits.h"
#include "experiments/sweep/report.h"
#include "renderer/error.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;

std::vector<std::string> default_scenes(bool gpu) {
  std::vector<std::string> scenes;
  for (const int triangles : {swept_triangles[0], swept_triangles[1]})
    for (int lights = gpu ? 1 : swept_lights; lights <= swept_lights; ++lights)
      for (const int objects : gpu ? std::vector<int>(swept_objects.begin(), swept_objects.end())
                                   : std::vector<int>{1, 10, 50})
        scenes.push_back(sweep_scene({objects, triangles, lights}));
  return scenes;
}

std::vector<std::string> default_techniques(bool gpu) {
  std::vector<std::string> names;
  for (const auto& row : table_4_1()) names.push_back(row.technique);
  if (gpu)
    for (const auto& technique : techniques::all())
      if (technique.family != "truth" && technique.family != "traced" &&
          std::find(names.begin(), names.end(), technique.id) == names.end())
        names.push_back(technique.id);
  return names;
}

std::vector<std::uint32_t> checked_sizes(const std::vector<std::uint32_t>& given, bool gpu) {
  if (given.empty()) return gpu ? swept_sizes() : std::vector<std::uint32_t>{100, 300};
  for (const std::uint32_t size : given)
    if (size == 0 || size > RenderLimits::max_size)
      throw bad_value("sizes", "a size is 1 to " + std::to_string(RenderLimits::max_size) +
                                   " pixels, not " + std::to_string(size));
  return given;
}

/// More objects for the techniques of table 4.1 that are still in real time with all of the grid's:
/// doubled until they are not, at the largest size.
std::vector<Run> more_objects(const std::vector<json>& rows, const std::vector<Run>& runs,
                              int objects) {
  std::vector<Run> more;
  std::set<std::string> known;
  for (const json& row : rows)
    if (number_of(row, "width") == runs.back().width && is_done(row) &&
        number_of(row, "frame_ms") < real_time_ms) {
      const auto scene = read_sweep_scene(row.at("scene").get<std::string>());
      if (scene && scene->lights == swept_lights && scene->objects == objects / 2)
        known.insert(sweep_scene({objects, scene->triangles, swept_lights}) + " " +
                     row.at("name").get<std::string>());
    }
  for (const Run& run : runs) {
    const auto scene = read_sweep_scene(run.scene);
    if (!scene || scene->objects != swept_objects.back() || scene->lights != swept_lights ||
        run.width != runs.back().width)
      continue;
    Run next = run;
    next.scene = sweep_scene({objects, scene->triangles, swept_lights});
    const bool is_of_table =
        std::any_of(table_4_1().begin(), table_4_1().end(),
                    [&](const PublishedLimit& row) { return row.technique == run.name; });
    if (is_of_table && known.contains(next.scene + " " + next.name)) more.push_back(next);
  }
  return more;
}

}  // namespace

std::vector<Run> sweep_runs(const SweepOptions& options, bool gpu) {
  const auto scenes =
      options.scenes.empty() ? default_scenes(gpu) : matching_scenes(options.scenes);
  std::vector<NamedTechnique> techniques{read_technique(technique_of_family("none").id)};
  for (const std::string& text :
       options.techniques.empty() ? default_techniques(gpu) : options.techniques) {
    const bool known = std::any_of(techniques.begin(), techniques.end(),
                                   [&](const NamedTechnique& t) { return t.name == text; });
    if (!known) techniques.push_back(read_technique(text));
  }
  auto sizes = checked_sizes(options.sizes, gpu);
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  std::vector<Run> runs;
  for (const std::string& scene : scenes)
    for (const std::uint32_t size : sizes)
      for (const NamedTechnique& technique : techniques) {
        Run& run = runs.emplace_back();
        run.scene = scene;
        run.technique = technique.id;
        run.parameters = technique.parameters;
        run.name = technique.name;
        run.width = run.height = size;
        run.light_samples = options.light_samples;
        run.truth = options.errors ? Truth::area : Truth::none;
      }
  return runs;
}

json sweep(const SweepOptions& options) {
  Engine engine(options.engine);
  const auto runs = sweep_runs(options, engine.device().type != "cpu");
  std::vector<json> rows = run_all(engine, runs, options.progress);
  for (int objects = 2 * swept_objects.back(); objects <= most_objects; objects *= 2) {
    const auto more = run_all(engine, more_objects(rows, runs, objects), options.progress);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  const json device = {{"name", engine.device().name},
                       {"driver", engine.device().driver},
                       {"type", engine.device().type}};
  const auto files = write_sweep_report(options.engine.folder, device, options.command, rows);
  const auto failed =
      std::count_if(rows.begin(), rows.end(), [](const json& row) { return !is_done(row); });
  return {{"device", device},
          {"rows", rows.size()},
          {"measured", engine.measured()},
          {"failed", failed},
          {"files", files}};
}

}  // namespace penumbra::experiments
