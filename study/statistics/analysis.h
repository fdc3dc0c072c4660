#pragma once

#include <nlohmann/json.hpp>

#include "study/statistics/bootstrap.h"
#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

struct AnalysisSettings {
  double alpha = 0.05;
  Resampling resampling;
};

/// Everything that is reported of one table, in the shape of the contract's scenes and overall:
/// techniques by weighted mean rank, omnibus tests, pairs, subsets and letters. Means, weighted
/// means and order are of the digits as typed where every page has them (`ranks_of`), as in 2007;
/// tests on ranks are of mid-ranks always.
nlohmann::json analyse(const SurveyData& data, const ParticipantTable& table,
                       const AnalysisSettings& settings);

/// The analysis of 2007 alone on the same table: means, paired t, subsets. For the twin whose rows
/// are pages, "all results of all surveys".
nlohmann::json analyse_as_in_2007(const SurveyData& data, const ParticipantTable& table,
                                  double alpha);

}  // namespace penumbra::study::statistics
