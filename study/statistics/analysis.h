#pragma once

#include <nlohmann/json.hpp>

#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// Everything that is reported of one table, in the shape of the contract's scenes and overall:
/// techniques by weighted mean rank, omnibus tests, pairs, subsets and letters.
nlohmann::json analyse(const SurveyData& data, const ParticipantTable& table, double alpha);

}  // namespace penumbra::study::statistics
