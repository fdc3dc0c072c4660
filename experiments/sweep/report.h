#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace penumbra::experiments {

/// results.csv, figures/*.svg and report.html of a sweep. Returns the files' names within `folder`.
std::vector<std::string> write_sweep_report(const std::filesystem::path& folder,
                                            const nlohmann::json& device,
                                            const std::string& command,
                                            const std::vector<nlohmann::json>& rows);

/// Our table 4.1 beside the published one: a row for each of its techniques that was measured.
struct LimitRow {
  std::string label;
  std::string technique;
  std::string published;                    ///< low, high, bottleneck, in words
  std::vector<std::string> limit1, limit2;  ///< low poly, high poly
  std::vector<double> objects;              ///< limit 2; beyond counts as what was measured
  std::string growth;
  std::string bottleneck;
};
std::vector<LimitRow> limit_rows(const std::vector<nlohmann::json>& rows);

}  // namespace penumbra::experiments
