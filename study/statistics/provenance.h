#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/statistics/report.h"
#include "study/statistics/screening.h"

namespace penumbra::study::statistics {

/// People who entered, were taken out, were flagged, finished, or stopped early. Finished are those
/// with a page of every scene; those who stopped are inside all results and counted here.
nlohmann::json counts_json(const SurveyData& data, const std::vector<Flag>& flags);

/// Names and rules of all methods, with what fixes their numbers: alpha, seed, resamples,
/// libraries.
nlohmann::json methods_json(const ReportOptions& options);

/// SHA-256 of what was analysed, whatever the order of its rows.
std::string data_digest(const SurveyData& data);

nlohmann::json notes_json(const SurveyData& data);

/// What a reader must know before using a result of this report: [{"set", "part", "warning"}].
nlohmann::json warnings_json(const nlohmann::json& report);

}  // namespace penumbra::study::statistics
