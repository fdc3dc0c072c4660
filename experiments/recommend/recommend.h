#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/engine/engine.h"
#include "experiments/report/ranks.h"

namespace penumbra::experiments::recommend {

/// What is to be small.
struct Objective {
  const char* name;    ///< as --objective takes it
  const char* column;  ///< of a row and of results.csv; empty: ranks of a study
  const char* words;
  bool all_views;  ///< the largest over several cameras and lights
};
const std::vector<Objective>& objectives();
/// Throws bad_value (field "objective").
const Objective& objective_named(const std::string& name);

struct Options {
  EngineOptions engine;
  std::string scene;
  std::optional<double> budget_ms;     ///< of a frame; empty: real time, 50 ms
  std::optional<double> memory_bytes;  ///< over `none`
  std::string objective = "rms";
  std::vector<std::string> from;        ///< results.csv of further experiments
  std::string study = published_ranks;  ///< for `perceived` (perceived_ranks)
  std::uint32_t size = 256;             ///< pixels along an edge
  std::uint32_t light_samples = 256;    ///< of the reference
  std::string command;                  ///< as the report quotes it
  std::function<void(const Progress&)> progress;
};

/// Chooses by the model (model.h) and measures what it proposes. Then tries what the scene does not
/// need: smaller maps, lights without softness, casters that shadow nothing; each with what it
/// saves. Writes results.csv, figures/trials.svg and report.html. Goes on where it was stopped.
/// Returns {"device", "scene", "objective", "budget", "recommendation", "savings", "refused",
/// "tried", "model", "files", "rows", "measured"}.
nlohmann::json recommend(const Options& options);

/// Judges the model on scenes that it never saw (evaluate.h), from `from`, or without it from what
/// the program brings along for a processor or a GPU: nothing is drawn. Writes results.csv, figures
/// and report.html. Returns the evaluation.
nlohmann::json evaluate_model(const Options& options, bool gpu);

}  // namespace penumbra::experiments::recommend
