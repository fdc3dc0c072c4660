#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/engine/engine.h"

namespace penumbra::experiments {

struct SweepOptions {
  EngineOptions engine;
  std::vector<std::string> scenes;      ///< patterns; empty: the default
  std::vector<std::string> techniques;  ///< as read_technique takes them; empty: the default
  std::vector<std::uint32_t> sizes;     ///< pixels along an edge; empty: the default
  bool errors = false;                  ///< also judge every picture against the reference
  std::uint32_t light_samples = 256;    ///< of that reference
  std::string command;                  ///< as the report quotes it
  std::function<void(const Progress&)> progress;
};

/// The runs of a sweep. Defaults on a GPU: the 588 combinations of scene and size of van Sambeek
/// 2007 with every technique but those that trace rays; on a processor, so that it takes minutes:
/// three lights, 1, 10 and 50 objects, pictures of 100 and 300, the techniques of his table 4.1.
/// `none` is always among them. Throws bad_value and not_found naming scenes, techniques or sizes.
std::vector<Run> sweep_runs(const SweepOptions& options, bool gpu);

/// Measures and writes results.csv, figures/*.svg and report.html. Goes on where it was stopped.
/// Returns {"device", "rows", "measured", "failed", "files"}.
nlohmann::json sweep(const SweepOptions& options);

}  // namespace penumbra::experiments
