#include "experiments/tradeoff/tradeoff.h"

#include <algorithm>

#include "experiments/report/ranks.h"
#include "experiments/report/rows.h"
#include "experiments/sweep/grid.h"
#include "experiments/tradeoff/report.h"
#include "experiments/tradeoff/search.h"
#include "renderer/error.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;

/// Offsets granted to comparisons, metres, and maps, texels along an edge.
constexpr double biases[] = {0.0, 0.0005, 0.002, 0.01, 0.05, 0.2};
constexpr std::int64_t bias_maps[] = {256, 512, 1024};

bool has(const TechniqueDescription& technique, const std::string& parameter) {
  return std::any_of(technique.parameters.begin(), technique.parameters.end(),
                     [&](const Parameter& p) { return p.name == parameter; });
}

/// A technique's own parameters: what all share says how colours are encoded, not how shadows are.
std::vector<Parameter> own_parameters(const TechniqueDescription& technique) {
  const auto& shared = technique_of_family("none").parameters;
  std::vector<Parameter> own;
  for (const Parameter& parameter : technique.parameters)
    if (std::none_of(shared.begin(), shared.end(),
                     [&](const Parameter& p) { return p.name == parameter.name; }))
      own.push_back(parameter);
  return own;
}

std::vector<const TechniqueDescription*> techniques_of(const TradeoffOptions& options) {
  std::vector<const TechniqueDescription*> list;
  if (options.techniques.empty()) {
    if (options.bias) {
      // The plain map: filters hide what a bias does.
      list.push_back(techniques::resolve(table_4_1()[1].technique).technique);
      return list;
    }
    for (const auto& technique : techniques::all())
      if (technique.family != "truth" && technique.family != "none") list.push_back(&technique);
    return list;
  }
  for (const std::string& id : options.techniques) {
    const auto* technique = techniques::resolve(id).technique;
    if (technique->id != id)
      throw bad_value("techniques", "'" + id + "' is a preset of " + technique->id +
                                        ": the search takes techniques, whose parameters it sets");
    if (options.bias && !(has(*technique, "bias") && has(*technique, "bias_strategy")))
      throw bad_value("techniques", "'" + id + "' has no bias");
    if (std::find(list.begin(), list.end(), technique) == list.end()) list.push_back(technique);
  }
  return list;
}

/// `technique` as read_technique takes it.
Run run_of(const TradeoffOptions& options, const std::string& technique) {
  const NamedTechnique named = read_technique(technique);
  Run run;
  run.scene = options.scene;
  run.technique = named.id;
  run.parameters = named.parameters;
  run.width = run.height = options.size;
  run.light_samples = options.light_samples;
  run.truth = options.bias ? Truth::hard : Truth::area;
  run.picture = !options.bias;
  return run;
}

/// Tells the rank of the newest row, or of an earlier one of the same run.
void add_rank(std::vector<json>& rows, double rank) {
  const auto same = std::find_if(rows.begin(), rows.end(), [&](const json& row) {
    return row.at("technique") == rows.back().at("technique") &&
           row.at("given") == rows.back().at("given");
  });
  if (same != rows.end() - 1) rows.pop_back();
  (*same)[perceived.key] = rank;
  // Against itself what judges has no error to tell.
  if (same->at("family") == "truth")
    for (const Objective& objective : objectives()) same->erase(objective.key);
}

std::vector<json> search_all(Engine& engine, const TradeoffOptions& options, const Ranks& ranks) {
  const auto list = techniques_of(options);
  std::vector<json> rows;
  const auto start = std::chrono::steady_clock::now();
  const std::size_t searched = 1 + list.size() * options.runs_per_technique;
  Progress now{0, searched + ranks.mean.size(), 0, {}, {}};
  const auto measure = [&](const Run& run) {
    now.what = run.technique;
    now.measured = engine.measured();
    if (now.measured > 0)
      now.left_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
                   static_cast<double>(now.measured) * static_cast<double>(now.total - now.done);
    if (options.progress) options.progress(now);
    rows.push_back(engine.measure(run));
    ++now.done;
    return rows.back();
  };
  const json none = measure(run_of(options, technique_of_family("none").id));
  if (!is_done(none))
    throw Error(none.at("error").at("code"), none.at("error").at("message"),
                none.at("error").at("field"));
  for (std::size_t i = 0; i < list.size(); ++i) {
    search(own_parameters(*list[i]), options.runs_per_technique,
           [&](const ParameterValues& given) -> std::optional<Scores> {
             Run run = run_of(options, list[i]->id);
             run.parameters = given;
             const json row = measure(run);
             if (!is_done(row)) return std::nullopt;
             Scores scores{number_of(row, "frame_ms"), {}};
             for (const Objective& objective : objectives())
               scores.errors.push_back(number_of(row, objective.key));
             return scores;
           });
    now.done = 1 + (i + 1) * options.runs_per_technique;
  }
  for (const auto& [name, rank] : ranks.mean) {
    measure(run_of(options, name));
    add_rank(rows, rank);
  }
  now.what.clear();
  now.done = now.total;
  if (options.progress) options.progress(now);
  return rows;
}

std::vector<Run> bias_runs(const TradeoffOptions& options) {
  std::vector<Run> runs;
  for (const TechniqueDescription* technique : techniques_of(options)) {
    const auto strategy =
        std::find_if(technique->parameters.begin(), technique->parameters.end(),
                     [](const Parameter& p) { return p.name == "bias_strategy"; });
    for (const std::int64_t map : bias_maps)
      for (const std::string& choice : strategy->choices)
        for (const double bias : biases) {
          Run run = run_of(options, technique->id);
          run.parameters = {{"map_size", map}, {"bias_strategy", choice}, {"bias", bias}};
          runs.push_back(run);
        }
  }
  return runs;
}

}  // namespace

const std::vector<Objective>& objectives() {
  static const std::vector<Objective> list{
      {"visibility_rms", "root mean square error of visibility, 0 to 1"},
      {"rms_y", "root mean square error of luma, levels of 0 to 255"},
      {"flip", "FLIP, 0 to 1"}};
  return list;
}

json tradeoff(const TradeoffOptions& options) {
  if (options.size == 0 || options.size > RenderLimits::max_size)
    throw bad_value("size", "size must be 1 to " + std::to_string(RenderLimits::max_size));
  if (options.bias && !options.study.empty())
    throw bad_value("study", "people ranked pictures, not biases: leave out study or bias");
  techniques_of(options);  // throws before a device is made
  Ranks ranks;
  if (!options.study.empty()) ranks = perceived_ranks(options.study, options.scene);
  Engine engine(options.engine);
  const std::vector<json> rows = options.bias
                                     ? run_all(engine, bias_runs(options), options.progress)
                                     : search_all(engine, options, ranks);
  const json device = {{"name", engine.device().name},
                       {"driver", engine.device().driver},
                       {"type", engine.device().type}};
  json summary =
      options.bias
          ? write_bias_report(options.engine.folder, device, options.command, rows)
          : write_tradeoff_report(options.engine.folder, device, options.command, rows, ranks);
  summary["device"] = device;
  summary["rows"] = rows.size();
  summary["measured"] = engine.measured();
  summary["failed"] =
      std::count_if(rows.begin(), rows.end(), [](const json& row) { return !is_done(row); });
  return summary;
}

}  // namespace penumbra::experiments
