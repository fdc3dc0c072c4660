#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/engine/engine.h"

namespace penumbra::experiments {

struct TradeoffOptions {
  EngineOptions engine;
  std::string scene;
  std::vector<std::string> techniques;  ///< ids; empty: the default
  bool bias = false;
  std::string study;                    ///< whose ranks to hold against time; empty: none
  std::uint32_t size = 300;             ///< pixels along an edge
  std::uint32_t light_samples = 256;    ///< of the reference
  std::size_t runs_per_technique = 30;  ///< of the search
  std::string command;                  ///< as the report quotes it
  std::function<void(const Progress&)> progress;
};

/// What is traded: key of a row, and its name in words.
struct Objective {
  const char* key;
  const char* words;
  bool by_people = false;  ///< known of what a study showed, not of what a search finds
};
const std::vector<Objective>& objectives();
inline constexpr Objective perceived{"perceived", "mean rank that people gave, 1 most realistic",
                                     true};

/// Searches every technique's own parameters for the front of error against time (search.h), or,
/// with `bias`, measures errors over bias, strategy and map size against exact hard shadows. With a
/// `study` (perceived_ranks) it also measures what that study showed. Writes results.csv,
/// figures/*.svg and report.html. Goes on where it was stopped. Returns {"device",
/// "rows", "measured", "failed", "files", "fronts": {objective: [row]}}. Throws bad_value and
/// not_found naming scene, techniques, size or study.
nlohmann::json tradeoff(const TradeoffOptions& options);

}  // namespace penumbra::experiments
