#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// Plackett-Luce worths of `techniques` over the pages of one scene, or of all where `scene` is
/// empty, every page one ranking; robust errors are clustered by participant. Shape of the
/// contract's `plackett_luce`; without a fit its numbers are null and `reason` says why.
nlohmann::json worths_json(const SurveyData& data, const Selection& selection,
                           std::optional<std::size_t> scene,
                           const std::vector<std::string>& techniques);

}  // namespace penumbra::study::statistics
