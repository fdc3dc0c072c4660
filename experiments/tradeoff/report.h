#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/report/ranks.h"

namespace penumbra::experiments {

/// Both write results.csv, figures/*.svg and report.html and return {"files", "fronts"}: fronts are
/// rows by objective, the fastest first. Rows with `perceived` also make a front over ranks.
nlohmann::json write_tradeoff_report(const std::filesystem::path& folder,
                                     const nlohmann::json& device, const std::string& command,
                                     const std::vector<nlohmann::json>& rows, const Ranks& ranks);
nlohmann::json write_bias_report(const std::filesystem::path& folder, const nlohmann::json& device,
                                 const std::string& command,
                                 const std::vector<nlohmann::json>& rows);

/// Indices of the rows that none beats in both frame_ms and `error`, the fastest first.
std::vector<std::size_t> front_rows(const std::vector<nlohmann::json>& rows,
                                    const std::string& error);

}  // namespace penumbra::experiments
