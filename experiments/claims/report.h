#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/claims/run.h"

namespace penumbra::experiments::claims {

/// The folder and its figures/. Throws Error `unwritable`, field `out`.
void make_folder(const std::filesystem::path& folder);

/// Into a folder that was made: writes results.csv (a line a claim), runs.csv (a line a picture),
/// figures and report.html; returns their names. `device` may be null.
std::vector<std::string> write_report(const std::filesystem::path& folder,
                                      const nlohmann::json& device, const std::string& command,
                                      const std::vector<Judged>& list,
                                      const std::vector<nlohmann::json>& rows);

/// The table of claims as Markdown, for docs/.
void write_page(const std::filesystem::path& file, const nlohmann::json& device,
                const std::string& command, const std::vector<Judged>& list);

}  // namespace penumbra::experiments::claims
