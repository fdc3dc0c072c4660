#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/statistics/plackett_luce.h"
#include "study/statistics/table.h"

namespace penumbra::study::statistics {

/// Just objectionable differences: Thurstone's case V, scaled so that one JOD apart means 75 % of
/// judgements (Perez-Ortiz and Mantiuk 2017, arXiv:1712.03686). Studies by ranking and by pairs
/// compare on it.
struct JodScale {
  std::vector<double> scores;  ///< they sum to 0
  std::string reason;          ///< why there are none
};

/// Maximum likelihood from wins[i][j], how often i was preferred to j (ties as half wins). With
/// `prior`, their distance prior: how well each distance explains the other pairs' answers, which
/// shrinks distances of few comparisons. Without it unanimous answers have no finite scale.
JodScale scale_jod(const Table& wins, bool prior);

/// The contract's lists for one part: `jod` with the prior, and standard errors from the sandwich
/// of the likelihood's scores clustered by participant.
nlohmann::json jod_json(const std::vector<Ranking>& rankings,
                        const std::vector<std::string>& techniques);

}  // namespace penumbra::study::statistics
