#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "study/statistics/screening.h"
#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// P of Fisher's exact test, two-sided: the tables with the same margins that are no likelier.
double fisher_exact(std::size_t a_yes, std::size_t a_no, std::size_t b_yes, std::size_t b_no);

/// What the ways of giving ranks did to people: {"list": [{"arm", "participants", "inverted",
/// "read_right", "ci95", "mean_rho", "techniques": [{"technique", "n", "mean_rank"}]}],
/// "comparisons": [{"a", "b", "difference", "p_value", "p_holm"}]}. Null where the study has one
/// way only.
nlohmann::json arms_json(const SurveyData& data, const std::vector<Flag>& flags);

}  // namespace penumbra::study::statistics
