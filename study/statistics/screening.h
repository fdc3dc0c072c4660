#pragma once

#include <string>
#include <vector>

#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// A reason to look at a participant again. Nothing is changed silently: results are given with and
/// without flagged participants.
struct Flag {
  std::size_t participant = 0;
  std::string name;  ///< inverted, page_inverted, unreliable, flat, fast, positional
  double value = 0.0;
  double threshold = 0.0;
  std::string reason;
  std::optional<std::size_t> page;  ///< index of the page that page_inverted means
};

/// Agreement of a page with the mean ranks that the other participants gave to the same scene;
/// empty where fewer than two others saw it or it is tied throughout.
struct Agreement {
  std::optional<double> rho;    ///< Spearman
  std::optional<double> tau_b;  ///< Kendall
};
std::vector<Agreement> leave_one_out(const SurveyData& data);

/// Agreement of ranks with slots, the places on the screen, averaged over a person's first
/// showings. Without preferences its standard deviation is `deviation`.
struct Position {
  std::optional<double> mean_rho;
  double deviation = 0.0;  ///< 1 / sqrt(sum over pages of (pictures - 1))
};
std::vector<Position> positions(const SurveyData& data);

/// Flags in order of participant and page.
std::vector<Flag> screen(const SurveyData& data, const Screening& thresholds);

}  // namespace penumbra::study::statistics
