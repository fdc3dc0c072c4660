#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/recommend/evaluate.h"

namespace penumbra::experiments::recommend {

/// Writes results.csv, figures/trials.svg and report.html; returns their names.
nlohmann::json write_report(const std::filesystem::path& folder, const nlohmann::json& device,
                            const std::string& command, const nlohmann::json& summary,
                            const std::vector<nlohmann::json>& rows);

/// Writes results.csv (a line for each case), figures/regret.svg and report.html; returns the
/// evaluation as JSON with "files" and "rows".
nlohmann::json write_evaluation(const std::filesystem::path& folder, const std::string& command,
                                const std::string& objective, const Evaluation& evaluation);

}  // namespace penumbra::experiments::recommend
