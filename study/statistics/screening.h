#pragma once

#include <string>
#include <vector>

#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// A reason to look at a participant again. Nothing is changed silently: results are given with and
/// without flagged participants.
struct Flag {
  std::size_t participant = 0;
  std::string name;  ///< inverted, page_inverted, unreliable, flat, fast
  double value = 0.0;
  double threshold = 0.0;
  std::string reason;
  std::optional<std::size_t> page;  ///< index of the page that page_inverted means
};

/// Leave-one-out Spearman correlation of each page with the mean ranks that the other participants
/// gave to the same scene; empty where fewer than two others saw it or it is tied throughout.
std::vector<std::optional<double>> leave_one_out_rho(const SurveyData& data);

/// Flags in order of participant and page.
std::vector<Flag> screen(const SurveyData& data, const Screening& thresholds);

}  // namespace penumbra::study::statistics
