#include "experiments/engine/engine.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "experiments/engine/versions.h"
#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "scenes/json_text.h"
#include "scenes/library.h"
#include "scenes/picture_io.h"
#include "techniques/parameter_schema.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

/// Changes with how runs are measured, where no digest tells.
constexpr int protocol = 2;

/// A time of `none` that is older is taken again: clocks and other work change meanwhile.
constexpr double baseline_s = 20.0;

const char* name_of(Truth truth) {
  return truth == Truth::area ? "area" : truth == Truth::hard ? "hard" : "none";
}

/// Families whose first technique draws the truth.
const char* family_of(Truth truth) {
  return truth == Truth::area ? "truth" : "traced";
}

json asked(const Run& run, const techniques::Resolved& technique) {
  return {{"scene", run.scene},
          {"technique", run.technique},
          {"name", run.name.empty() ? run.technique : run.name},
          {"label", technique.label},
          {"family", technique.technique->family},
          {"given", techniques::values_to_json(run.parameters)},
          {"width", run.width},
          {"height", run.height},
          {"truth", name_of(run.truth)}};
}

void add_cost(json& row, const Cost& cost) {
  row["frame_ms"] = cost.median_ms;
  row["p95_ms"] = cost.p95_ms;
  row["spread"] = cost.spread;
  row["frames"] = cost.frames;
  row["create_ms"] = cost.create_ms;
  std::uint64_t bytes = 0;
  for (const ResourceCost& resource : cost.technique_memory) bytes += resource.bytes;
  row["memory_bytes"] = bytes;
  std::uint64_t vertices = 0, primitives = 0, geometry = 0, fragments = 0, compute = 0;
  json passes = json::array();
  for (const PassCost& pass : cost.passes) {
    vertices += pass.vertex_invocations;
    primitives += pass.primitives;
    geometry += pass.geometry_primitives;
    fragments += pass.fragment_invocations;
    compute += pass.compute_invocations;
    passes.push_back({{"name", pass.name},
                      {"median_ms", pass.median_ms},
                      {"fragments", pass.fragment_invocations},
                      {"primitives", pass.primitives}});
  }
  row["vertices"] = vertices;
  row["primitives"] = primitives;
  row["geometry_primitives"] = geometry;
  row["fragments"] = fragments;
  row["compute"] = compute;
  row["passes"] = passes;
}

/// How far a picture lies from the truth.
void add_errors(json& row, const RenderResult& drawn, const Image8& picture,
                const ImageF& visibility) {
  const auto error = metrics::visibility_error(drawn.visibility, visibility, drawn.judged);
  row["rms_y"] = metrics::rms_y(drawn.picture, picture);
  row["flip"] = metrics::flip(drawn.picture, picture);
  row["visibility_rms"] = error.rms;
  row["false_shadow"] = error.false_shadow;
  row["missing_shadow"] = error.missing_shadow;
}

}  // namespace

const TechniqueDescription& technique_of_family(const std::string& family) {
  for (const TechniqueDescription& technique : techniques::all())
    if (technique.family == family) return technique;
  throw std::logic_error("no technique of family " + family);
}

bool is_baseline(const Run& run) {
  return run.technique == technique_of_family("none").id;
}

std::string view_of(const Run& run) {
  return std::to_string(run.width) + "x" + std::to_string(run.height) + " " +
         std::to_string(run.light_samples) + " " + name_of(run.truth) + " " + run.view.text();
}

Engine::Engine(EngineOptions options)
    : options_(std::move(options)),
      results_([this] {
        std::error_code failed;
        std::filesystem::create_directories(options_.folder / "pictures", failed);
        if (failed)
          throw Error("unwritable",
                      "cannot make " + options_.folder.string() + ": " + failed.message(), "out");
        return options_.folder / "results.jsonl";
      }()),
      renderer_(RendererOptions{options_.device}),
      timer_(renderer_, options_.timing) {}

std::shared_ptr<const Scene> Engine::scene(const std::string& name) {
  if (name != scene_name_ || !scene_) {
    scene_ = scenes::load(name, options_.data);
    scene_hash_ = scenes::content_hash(*scene_);
    scene_name_ = name;
    changed_.clear();
    judges_.clear();
    baselines_.clear();
  }
  return scene_;
}

json Engine::key_of(const Run& run, const techniques::Resolved& technique) {
  scene(run.scene);
  json key = {{"protocol", protocol},
              {"device", renderer_.device().name},
              {"driver", renderer_.device().driver},
              {"scene", scene_hash_},
              {"technique", technique.technique->id},
              {"version", technique_version(technique.technique->id)},
              {"parameters", techniques::values_to_json(technique.parameters)},
              {"width", run.width},
              {"height", run.height},
              {"light_samples", run.light_samples},
              {"run_ms", options_.timing.run_ms},
              {"picture", run.picture},
              {"truth", name_of(run.truth)}};
  // Runs that change nothing keep the keys that they had before scenes could be changed.
  if (!run.view.text().empty()) key["view"] = run.view.text();
  if (!run.hard_lights.empty()) key["hard_lights"] = run.hard_lights;
  if (run.idle_casters) key["idle_casters"] = true;
  if (run.truth != Truth::none)
    key["truth_version"] = technique_version(technique_of_family(family_of(run.truth)).id);
  return key;
}

Engine::~Engine() {
  try {
    while (begun() > 0) next();
  } catch (...) {  // what cannot be kept is measured again
  }
}

std::size_t Engine::most_begun() const {
  if (!options_.judged_beside.value_or(device().type != "cpu")) return 0;
  return std::max(2u, std::thread::hardware_concurrency()) - 1;
}

json Engine::measure(const Run& run) {
  if (begun() > 0) throw std::logic_error("other runs were begun");
  begin(run);
  return next();
}

// Names are the asker's: two names of one thing share a measurement.
bool Engine::is_known(const std::string& key) const {
  return results_.find(key) != nullptr ||
         std::any_of(begun_.begin(), begun_.end(), [&](const Begun& b) { return b.key == key; });
}

void Engine::time_first(const std::vector<Run>& runs) {
  if (most_begun() == 0) return;
  timed_.clear();
  for (const Run& run : runs) {
    if (run.truth == Truth::none) continue;
    const techniques::Resolved technique = techniques::resolve(run.technique, run.parameters);
    const std::string key = scenes::json_text(key_of(run, technique));
    if (is_known(key) || timed_.contains(key)) continue;
    try {
      timed_[key] = time(run, request_of(run, technique));
    } catch (const Error&) {  // drawn for its errors it fails again, and that is kept
    }
  }
}

void Engine::begin(const Run& run) {
  const techniques::Resolved technique = techniques::resolve(run.technique, run.parameters);
  const std::string key = scenes::json_text(key_of(run, technique));
  std::future<json> fresh;
  if (!is_known(key)) fresh = measure_now(run, technique, key);
  begun_.push_back({asked(run, technique), key, std::move(fresh)});
}

json Engine::next() {
  Begun first = std::move(begun_.front());
  begun_.pop_front();
  if (first.fresh.valid()) {
    results_.add(first.key, first.fresh.get());
    ++measured_;
  }
  first.row.update(*results_.find(first.key));
  return first.row;
}

std::shared_ptr<const Scene> Engine::scene_for(const Run& run) {
  const auto plain = scene(run.scene);
  std::string what = run.view.text();
  for (const std::string& light : run.hard_lights) what += " hard " + light;
  if (what.empty()) return plain;
  auto& kept = changed_[what];
  if (!kept) {
    Scene changed = seen_from(*plain, run.view);
    for (Light& light : changed.lights)
      if (run.hard_lights.contains(light.name)) light.extent = {};
    kept = std::make_shared<const Scene>(std::move(changed));
  }
  return kept;
}

RenderRequest Engine::request_of(const Run& run, const techniques::Resolved& technique) {
  RenderRequest request;
  request.scene = scene_for(run);
  request.camera = run.view.camera;
  request.rules.casters = !run.idle_casters;
  request.technique = technique.technique;
  request.parameters = technique.parameters;
  request.width = run.width;
  request.height = run.height;
  request.light_samples = run.light_samples;
  request.visibility = run.truth != Truth::none;
  return request;
}

RenderRequest Engine::request_of(const Run& run) {
  return request_of(run, techniques::resolve(run.technique, run.parameters));
}

RenderRequest Engine::truth_of(const Run& run) {
  Run truth = run;
  truth.hard_lights.clear();
  truth.idle_casters = false;
  return request_of(truth, techniques::resolve(technique_of_family(family_of(run.truth)).id));
}

std::shared_ptr<const Engine::Judge> Engine::judge_of(const Run& run) {
  auto& known = judges_[view_of(run)];
  if (!known) {
    RenderResult drawn = renderer_.render(truth_of(run));
    known =
        std::make_shared<const Judge>(Judge{std::move(drawn.picture), std::move(drawn.visibility)});
  }
  return known;
}

const Engine::Baseline& Engine::baseline_of(const Run& run) {
  Baseline& baseline = baselines_[view_of(run)];
  const auto now = Clock::now();
  if (baseline.ms == 0.0 ||
      std::chrono::duration<double>(now - baseline.when).count() > baseline_s) {
    const Cost cost =
        timer_.time(request_of(run, techniques::resolve(technique_of_family("none").id))).cost;
    baseline = {cost.median_ms, cost.settled, Clock::now()};
  }
  return baseline;
}

Engine::Timed Engine::time(const Run& run, const RenderRequest& request, const Cost* drawn) {
  const std::shared_ptr<void> alone = options_.alone ? options_.alone() : nullptr;
  Timed timed;
  if (!is_baseline(run)) timed.before = baseline_of(run);
  RenderResult frames = timer_.time(request, drawn);
  timed.cost = std::move(frames.cost);
  timed.notes = std::move(frames.notes);
  if (is_baseline(run))
    baselines_[view_of(run)] = {timed.cost.median_ms, timed.cost.settled, Clock::now()};
  return timed;
}

std::future<json> Engine::measure_now(const Run& run, const techniques::Resolved& technique,
                                      const std::string& key) {
  json row = {{"status", "done"}, {"error", nullptr}};
  auto drawn = std::make_shared<RenderResult>();
  std::shared_ptr<const Judge> judge;
  const auto failed = [](json failed_row, const Error& error) {
    if (error.code == "device" || error.code == "unwritable" || error.field == "out") throw;
    failed_row["status"] = "failed";
    failed_row["error"] = {{"code", error.code}, {"message", error.what()}, {"field", error.field}};
    return failed_row;
  };
  try {
    // The truth first: nothing may come between the times of `none` and of the technique.
    if (run.truth != Truth::none) judge = judge_of(run);
    const RenderRequest request = request_of(run, technique);
    auto known = timed_.extract(key);
    const bool looked_at = judge || run.picture;
    if (looked_at) *drawn = renderer_.render(request);
    Timed timed = known.empty() ? time(run, request, looked_at ? &drawn->cost : nullptr)
                                : std::move(known.mapped());
    // The first that was drawn compiled what both need.
    if (known.empty() && looked_at) timed.cost.create_ms = drawn->cost.create_ms;
    add_cost(row, timed.cost);
    row["notes"] = looked_at ? drawn->notes : timed.notes;
    const double none_ms = is_baseline(run) ? timed.cost.median_ms : timed.before.ms;
    row["settled"] = timed.cost.settled && timed.before.settled;
    row["none_ms"] = none_ms;
    row["over_none"] = none_ms > 0.0 ? json(timed.cost.median_ms / none_ms) : json(nullptr);
  } catch (const Error& error) {
    row = failed(row, error);
    return std::async(std::launch::deferred, [row] { return row; });
  }
  // Results are kept in the order of their beginning, so that this will be its number.
  const auto place = results_.size() + static_cast<std::size_t>(std::count_if(
                                           begun_.begin(), begun_.end(),
                                           [](const Begun& b) { return b.fresh.valid(); }));
  const auto finish = [row, drawn, judge, failed, place, keep = run.picture,
                       folder = options_.folder]() mutable {
    try {
      if (judge) add_errors(row, *drawn, judge->picture, judge->visibility);
      if (keep) {
        char name[32];
        std::snprintf(name, sizeof name, "pictures/%05zu.png", place);
        scenes::write_picture(folder / name, drawn->picture);
        row["picture"] = name;
      }
      return row;
    } catch (const Error& error) {
      return failed(row, error);
    }
  };
  return std::async(most_begun() > 0 ? std::launch::async : std::launch::deferred, finish);
}

std::vector<std::string> parts_of(const std::string& list, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, separator);) {
    const auto first = part.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    parts.push_back(part.substr(first, part.find_last_not_of(" \t") - first + 1));
  }
  return parts;
}

NamedTechnique read_technique(const std::string& text) {
  const auto parts = parts_of(text, ':');
  if (parts.empty()) throw bad_value("techniques", "a technique's id is empty");
  NamedTechnique technique{text, parts.front(), {}};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto sign = parts[i].find('=');
    if (sign == std::string::npos)
      throw bad_value("techniques",
                      "'" + text + "': a parameter is written NAME=VALUE, not '" + parts[i] + "'");
    technique.parameters[parts[i].substr(0, sign)] = parts[i].substr(sign + 1);
  }
  technique.parameters = [&] {
    // Checked now, so that a slip is told before hours of measuring.
    const auto complete = techniques::resolve(technique.id, technique.parameters).parameters;
    ParameterValues given;
    for (const auto& [name, value] : technique.parameters) given[name] = complete.at(name);
    return given;
  }();
  return technique;
}

}  // namespace penumbra::experiments
