#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/statistics/bootstrap.h"
#include "study/statistics/descriptives.h"
#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// Descriptives of one column: unweighted over participants' means, weighted over pages; of digits
/// where the table has them, otherwise of mid-ranks.
Descriptives describe_technique(const ParticipantTable& table, std::size_t index);

/// Columns by weighted mean rank, then mean rank, then name; techniques without one come last.
ParticipantTable in_display_order(const ParticipantTable& table);

std::vector<std::string> technique_names(const SurveyData& data, const ParticipantTable& table);

/// The contract's `techniques` of one table.
nlohmann::json techniques_json(const std::vector<std::string>& names, const ParticipantTable& table,
                               const Resampling& resampling);

}  // namespace penumbra::study::statistics
