#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/claims/claim.h"
#include "experiments/engine/engine.h"

namespace penumbra::experiments::claims {

struct Options {
  EngineOptions engine;
  std::vector<std::string> only;  ///< ids; empty: all
  bool quick = false;             ///< small pictures
  std::string command;            ///< as reports quote it
  std::filesystem::path page;     ///< where to write the table as Markdown; may be empty
  std::function<void(const Progress&)> progress;
};

/// A claim and what came of it.
struct Judged {
  const Claim* claim = nullptr;
  Outcome outcome;
  Verdict verdict = Verdict::not_measured;
};

/// The verdict on parts that hold or do not: some of them is in part.
Verdict verdict_of(const std::vector<bool>& parts);

/// Measures claims and writes results.csv, runs.csv, figures/*.svg and report.html; goes on where
/// it was stopped. Returns {"claims":
/// [{"id","statement","source","rule","verdict","numbers","note"}], "device": null where none was
/// needed, "measured", "files"}. Throws bad_value, field "only", for ids that there are not, and
/// what the device or the folder throws; a claim that cannot be measured is a verdict.
nlohmann::json run(const Options& options);

}  // namespace penumbra::experiments::claims
