#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// Screening of observers by ITU-R BT.500-13, annex 2, 2.3.1: how often a person's ranks lie beyond
/// the mean of a picture by 2 standard deviations (sqrt 20 where its kurtosis is outside 2 to 4).
/// For comparison only: in
/// small groups a person who read the scale backwards widens the limits and passes.
struct Bt500 {
  std::size_t above = 0;  ///< P
  std::size_t below = 0;  ///< Q
  std::size_t judged = 0;
  bool rejected = false;  ///< (P + Q) / judged > 0.05 and |P - Q| / (P + Q) < 0.3
};
std::vector<Bt500> bt500(const SurveyData& data);

/// Per participant: pages, mean leave-one-out rho and tau-b, tau-b of repeated pages, agreement of
/// ranks with slots, and BT.500.
nlohmann::json raters_json(const SurveyData& data);

}  // namespace penumbra::study::statistics
