#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/responses.h"
#include "study/statistics/table.h"

namespace penumbra::study::statistics {

/// One page of one participant. Lists have an entry per technique of the survey, NaN where the page
/// did not show it.
struct PageAnswer {
  std::size_t participant = 0;  ///< index into SurveyData::participants
  std::size_t scene = 0;
  int page_index = 0;
  int repeat = 0;
  std::size_t pictures = 0;
  std::vector<double> doubled_ranks;  ///< twice the mid-rank among the page's pictures
  std::vector<double> digits;         ///< as typed
  std::vector<double> slots;
  std::optional<double> weight;  ///< of the page; the difficulty unless given
  std::optional<double> active_ms;
};

/// Rows gathered into pages. Names are sorted, so that the order of rows does not matter.
struct SurveyData {
  std::vector<std::string> participants;
  std::vector<std::string> scenes;
  std::vector<std::string> techniques;
  std::vector<PageAnswer> pages;       ///< by participant, scene, page_index, repeat
  std::vector<std::string> taken_out;  ///< participants that a researcher took out
};

/// Rows of participants who were taken out are left aside. Ranks are made anew from each page's
/// order, so that dense places, competition ranks and mid-ranks all mean the same.
SurveyData gather(const std::vector<ResponseRow>& rows);

/// Which pages enter an analysis, and which of them are turned round.
struct Selection {
  std::vector<bool> used;    ///< per page of the survey
  std::vector<bool> turned;  ///< per page: rank r becomes n + 1 - r, digit d becomes 10 - d
};

/// Values of some techniques by participant: blocks are participants, also where several pages are
/// pooled.
struct ParticipantTable {
  std::vector<std::size_t> participants;
  std::vector<std::size_t> techniques;
  Table scaled_ranks;  ///< mean mid-rank times `scale`, an integer
  double scale = 2.0;
  Table weighted_ranks;  ///< sum(w r) / sum(w) over the participant's pages
  Table weights;         ///< sum(w), 0 where no page has a weight
  Table digits;          ///< mean digit; empty unless every page was answered with digits
  std::size_t pages = 0;
  bool any_weight = false;   ///< else every page counts 1
  bool single_pages = true;  ///< nobody has more than one page here
};

/// Of one scene, or of all where `scene` is empty. Repeated showings are left out.
ParticipantTable participant_table(const SurveyData& data, const Selection& selection,
                                   std::optional<std::size_t> scene);

}  // namespace penumbra::study::statistics
