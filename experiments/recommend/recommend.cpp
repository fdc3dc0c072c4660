#include "experiments/recommend/recommend.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "experiments/recommend/evaluate.h"
#include "experiments/recommend/model.h"
#include "experiments/recommend/report.h"
#include "experiments/recommend/savings.h"
#include "experiments/report/rows.h"
#include "experiments/sweep/limits.h"
#include "renderer/error.h"
#include "renderer/plan/plan.h"
#include "techniques/parameter_schema.h"

namespace penumbra::experiments::recommend {
namespace {

using nlohmann::json;

/// How far cameras and lights are turned for the worst of several views, degrees.
constexpr double turn = 25.0;

std::vector<View> views_of(const Scene& scene, bool all) {
  std::vector<View> views{{}};
  if (!all) return views;
  for (const double side : {-turn, turn}) {
    views.push_back({.camera = {}, .camera_turn = side, .light_turn = 0.0});
    views.push_back({.camera = {}, .camera_turn = 0.0, .light_turn = side});
  }
  for (std::size_t i = 1; i < scene.cameras.size(); ++i)
    views.push_back({.camera = scene.cameras[i].name, .camera_turn = 0.0, .light_turn = 0.0});
  return views;
}

/// Measures candidates on the scene and remembers the rows.
class Bench {
 public:
  Bench(Engine& engine, const Options& options, const Objective& objective)
      : engine_(engine),
        options_(options),
        objective_(objective),
        views_(views_of(*engine.scene(options.scene), objective.all_views)) {}

  Run run_of(const std::string& candidate) const {
    const NamedTechnique technique = read_technique(candidate);
    Run run;
    run.scene = options_.scene;
    run.technique = technique.id;
    run.parameters = technique.parameters;
    run.name = candidate;
    run.width = run.height = options_.size;
    run.light_samples = options_.light_samples;
    run.truth = Truth::area;
    run.picture = true;
    return run;
  }

  /// The row of the worst view; the slowest view's time and bytes.
  json measure(Run run) {
    json worst;
    for (const View& view : views_) {
      run.view = view;
      tell(run.name + (view.text().empty() ? "" : ", " + view.text()));
      json row = engine_.measure(run);
      row["view"] = view.text();
      rows_.push_back(row);
      if (!is_done(row)) return row;
      if (worst.is_null()) {
        worst = row;
        continue;
      }
      const double ms = std::max(number_of(worst, "frame_ms"), number_of(row, "frame_ms"));
      if (number_of(row, objective_.column) > number_of(worst, objective_.column)) worst = row;
      worst["frame_ms"] = ms;
    }
    return worst;
  }

  Known known_of(const json& row) const {
    return {number_of(row, objective_.column), number_of(row, "frame_ms"),
            number_of(row, "memory_bytes")};
  }

  void tell(const std::string& what) {
    if (!options_.progress) return;
    Progress now;
    now.done = rows_.size();
    now.total = std::max(rows_.size() + 1, (1 + most_probes) * views_.size());
    now.measured = engine_.measured();
    now.what = what;
    options_.progress(now);
  }

  const std::vector<json>& rows() const { return rows_; }

 private:
  Engine& engine_;
  const Options& options_;
  const Objective& objective_;
  std::vector<View> views_;
  std::vector<json> rows_;
};

/// Why a candidate cannot draw the scene, told before anything is drawn; empty: it can.
std::string refusal_of(Engine& engine, const Run& run) {
  const RenderRequest request = engine.request_of(run);
  try {
    requirements_of(request, request.parameters, instance_boxes(*request.scene));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Whether errors are ranks that people gave.
bool is_by_people(const Objective& objective) {
  return *objective.column == '\0';
}

void add_files(Measured& measured, const Options& options, const Objective& objective) {
  for (const std::string& file : options.from) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error("unreadable", "cannot read " + file, "from");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    add_results(measured, text, objective.column);
  }
}

json choice_json(const json& row, const Known& known, bool fits, const Objective& objective) {
  const auto technique =
      techniques::resolve(row.at("technique"), techniques::values_from_json(row.at("given")));
  json parameters = techniques::values_to_json(technique.parameters);
  return {{"name", row.at("name")},
          {"technique", technique.technique->id},
          {"layout", parameters.value("layout", json(nullptr))},
          {"parameters", parameters},
          {"frame_ms", known.ms},
          {"none_ms", row.at("none_ms")},
          {"over_none", row.at("over_none")},
          {"memory_bytes", known.bytes},
          {"error", known.error},
          {"objective", objective.name},
          {"view", row.at("view")},
          {"fits", fits},
          {"passes", row.at("passes")},
          {"notes", row.at("notes")}};
}

void check(const Options& options) {
  if (options.size == 0 || options.size > RenderLimits::max_size)
    throw bad_value("size", "size must be 1 to " + std::to_string(RenderLimits::max_size));
  if (options.budget_ms && !(*options.budget_ms > 0.0))
    throw bad_value("budget_ms", "budget_ms must be above 0");
  if (options.memory_bytes && !(*options.memory_bytes >= 0.0))
    throw bad_value("memory_bytes", "memory_bytes must be at least 0");
  if (options.study != published_ranks && !is_by_people(objective_named(options.objective)))
    throw bad_value("study", "a study's ranks count for the objective perceived alone");
}

}  // namespace

const std::vector<Objective>& objectives() {
  static const std::vector<Objective> list{
      {"rms", "rms_y", "root mean square error of luma, levels of 0 to 255", false},
      {"flip", "flip", "FLIP, 0 to 1", false},
      {"worst", "visibility_rms",
       "root mean square error of visibility, 0 to 1, the largest over cameras and lights", true},
      {"perceived", "", "mean rank that people gave, 1 most realistic", false}};
  return list;
}

const Objective& objective_named(const std::string& name) {
  std::string names;
  for (const Objective& objective : objectives()) {
    if (objective.name == name) return objective;
    names += (names.empty() ? "" : ", ") + std::string(objective.name);
  }
  throw bad_value("objective", "objective must be one of " + names + ", not '" + name + "'");
}

namespace {

/// One recommendation while it is made.
class Search {
 public:
  Search(const Options& options, Engine& engine)
      : options_(options),
        objective_(objective_named(options.objective)),
        engine_(engine),
        bench_(engine, options, objective_),
        budget_{options.budget_ms.value_or(real_time_ms), options.memory_bytes} {}

  json run() {
    const json without = bench_.measure(bench_.run_of(technique_of_family("none").id));
    if (!is_done(without))
      throw Error(without.at("error").at("code"), without.at("error").at("message"),
                  without.at("error").at("field"));
    none_ = bench_.known_of(without);
    if (none_.error <= 0.0) none_.error = 1.0;  // nothing is in shadow: any ratio does
    const Choice choice = is_by_people(objective_) ? by_ranks() : by_model();
    if (choice.candidate.empty())
      throw Error("unsupported", "no technique that was measured draws this scene", "scene");
    json summary = told(choice);
    summary["savings"] = savings(engine_, bench_.run_of(choice.candidate),
                                 [&](const Run& run) { return bench_.measure(run); });
    return summary;
  }

  const std::vector<json>& rows() const { return bench_.rows(); }

 private:
  /// The names that the scene does not refuse.
  std::vector<std::string> drawable(const std::vector<std::string>& names) {
    std::vector<std::string> kept;
    for (const std::string& name : names) {
      const std::string reason = refusal_of(engine_, bench_.run_of(name));
      if (reason.empty())
        kept.push_back(name);
      else
        refused_.push_back({{"name", name}, {"reason", reason}});
    }
    return kept;
  }

  std::optional<Known> measure(const std::string& name, std::optional<double> error) {
    const json row = bench_.measure(bench_.run_of(name));
    if (!is_done(row)) {
      refused_.push_back({{"name", name}, {"reason", row.at("error").at("message")}});
      return std::nullopt;
    }
    Known known = bench_.known_of(row);
    if (error) known.error = *error;
    rows_[name] = row;
    tried_[name] = known;
    return known;
  }

  Choice by_model() {
    Measured before = measured_before(engine_.device().type != "cpu", objective_.column);
    add_files(before, options_, objective_);
    learnt_from_ = before.scenes.size();
    return choose(before, drawable(before.candidates()), none_, budget_,
                  [&](const std::string& name) { return measure(name, std::nullopt); });
  }

  /// In the order of people's ranks until one fits.
  Choice by_ranks() {
    const Ranks ranks = perceived_ranks(options_.study, options_.scene);
    for (const std::string& name : ranks.unknown)
      refused_.push_back({{"name", name}, {"reason", "no technique or preset has this id"}});
    std::vector<std::string> names;
    for (const auto& [name, rank] : ranks.mean) names.push_back(name);
    names = drawable(names);
    std::sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
      return ranks.mean.at(a) < ranks.mean.at(b);
    });
    Choice choice;
    for (const std::string& name : names) {
      const auto known = measure(name, ranks.mean.at(name));
      if (!known) continue;
      choice.probed.push_back(name);
      if (budget_.holds(*known)) break;
    }
    choice.candidate = best_of(tried_, budget_, 0.0);
    choice.fits = !choice.candidate.empty() && budget_.holds(tried_.at(choice.candidate));
    return choice;
  }

  json told(const Choice& choice) const {
    json tried = json::array();
    for (const std::string& name : choice.probed)
      tried.push_back({{"name", name},
                       {"frame_ms", tried_.at(name).ms},
                       {"memory_bytes", tried_.at(name).bytes},
                       {"error", tried_.at(name).error},
                       {"fits", budget_.holds(tried_.at(name))}});
    return {{"scene", options_.scene},
            {"size", options_.size},
            {"objective", {{"name", objective_.name}, {"words", objective_.words}}},
            {"budget",
             {{"ms", budget_.ms}, {"bytes", budget_.bytes ? json(*budget_.bytes) : json(nullptr)}}},
            {"none", {{"frame_ms", none_.ms}}},
            {"recommendation", choice_json(rows_.at(choice.candidate), tried_.at(choice.candidate),
                                           choice.fits, objective_)},
            {"refused", refused_},
            {"tried", tried},
            {"learnt_from_scenes", learnt_from_}};
  }

  const Options& options_;
  const Objective& objective_;
  Engine& engine_;
  Bench bench_;
  Budget budget_;
  Known none_;
  Probes tried_;
  std::map<std::string, json> rows_;
  json refused_ = json::array();
  std::size_t learnt_from_ = 0;
};

}  // namespace

json recommend(const Options& options) {
  check(options);
  Engine engine(options.engine);
  Search search(options, engine);
  json summary = search.run();
  const json device = {{"name", engine.device().name},
                       {"driver", engine.device().driver},
                       {"type", engine.device().type}};
  summary["device"] = device;
  summary["rows"] = search.rows().size();
  summary["measured"] = engine.measured();
  summary["files"] =
      write_report(options.engine.folder, device, options.command, summary, search.rows());
  return summary;
}

json evaluate_model(const Options& options, bool gpu) {
  const Objective& objective = objective_named(options.objective);
  if (is_by_people(objective) || objective.all_views)
    throw bad_value("objective",
                    std::string("--evaluate judges rms and flip, not ") + objective.name);
  Measured measured;
  if (options.from.empty()) measured = measured_before(gpu, objective.column);
  add_files(measured, options, objective);
  return write_evaluation(options.engine.folder, options.command, objective.words,
                          evaluate(measured));
}

}  // namespace penumbra::experiments::recommend
