#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// Gives every technique of `part` its `histogram`: how many pages gave it rank 1, 2, .. up to the
/// largest number of pictures of a page. A mid-rank between two ranks counts half to each. Pages of
/// one scene, or of all where `scene` is empty; repeated showings are left out.
void add_histograms(nlohmann::json& part, const SurveyData& data, const Selection& selection,
                    std::optional<std::size_t> scene);

/// What a critical-difference diagram shows (Demsar 2006), over the participants who saw
/// everything:
/// {"alpha", "participants", "value": smallest difference of mean ranks that Nemenyi's test calls
/// significant, "mean_ranks": {technique: mean of the ranks within participants}}. Without two
/// complete participants and two techniques, `value` is null and `reason` says why.
nlohmann::json critical_difference(const SurveyData& data, const ParticipantTable& table,
                                   double alpha);

}  // namespace penumbra::study::statistics
