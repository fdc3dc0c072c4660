#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/checks.h"
#include "study/responses.h"
#include "study/statistics/bootstrap.h"
#include "study/statistics/objective.h"
#include "study/statistics/survey_data.h"
#include "study/study.h"

namespace penumbra::study {

struct ReportOptions {
  AnalysisPlan plan;
  std::map<std::string, std::string> labels;  ///< abbreviation per picture id, for the text table
  std::string study_id;                       ///< put into the report where given
  std::string study_hash;
  statistics::Resampling resampling;  ///< of bootstraps and permutations
  Measures measures;                  ///< of the pictures that were shown; empty: not compared
  std::vector<GivenFlag> given_flags;
};

/// Options of a study: its analysis plan, the labels of its pictures, its id and hash.
ReportOptions report_options(const Study& study);

/// The document of `penumbra statistics --json` and results.json. Blocks are participants: the
/// pooled part works on each participant's mean mid-ranks. Rows of repeated pages only measure
/// reliability. What cannot be computed is null and a `reason` is beside it.
nlohmann::json survey_report(const statistics::SurveyData& data, const ReportOptions& options);
nlohmann::json statistics_report(const std::vector<ResponseRow>& rows,
                                 const ReportOptions& options);

/// Ordered means in their subset columns, laid out like van Sambeek 2007, tables 4.3 to 4.9: one
/// table per scene and one for all scenes, of the inclusion set `set`.
std::string statistics_table(const nlohmann::json& report, const ReportOptions& options,
                             const std::string& set = "all");

/// The report's `flags`: those that ranks give reason for, and the given ones of people with ranks.
nlohmann::json survey_flags(const statistics::SurveyData& data, const ReportOptions& options);

/// Flags per participant: [{"participant","flag","value","threshold","reason"}], those that ranks
/// give reason for.
nlohmann::json screening_flags(const statistics::SurveyData& data, const Screening& screening);
nlohmann::json flag_json(const GivenFlag& flag);

}  // namespace penumbra::study
