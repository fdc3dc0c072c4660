#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/statistics/plackett_luce.h"
#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// Imaginary comparisons of the regularised fit; the default of the R package PlackettLuce.
inline constexpr double default_pseudo_rankings = 0.5;

/// Every page of the selection as one ranking of `techniques`, clustered by participant.
std::vector<Ranking> rankings_of(const SurveyData& data, const Selection& selection,
                                 std::optional<std::size_t> scene,
                                 const std::vector<std::string>& techniques);

/// wins[i][j]: how often i was placed before j; equal places count half for both.
Table wins_of(const std::vector<Ranking>& rankings, std::size_t items);

/// Plackett-Luce worths of `techniques`, every page one ranking; robust errors are clustered by
/// participant. Shape of the contract's `plackett_luce`; without a fit its numbers are null and
/// `reason` says why. Beside it the regularised form, which is finite also where one technique
/// always wins, and Bradley-Terry.
nlohmann::json worths_json(const std::vector<Ranking>& rankings,
                           const std::vector<std::string>& techniques);

}  // namespace penumbra::study::statistics
