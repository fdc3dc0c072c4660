#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
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
  std::vector<double> digits;         ///< as typed, counted from 1 for the most realistic
  std::vector<double> slots;
  std::optional<double> weight;  ///< of the page; the difficulty unless given
  std::optional<double> active_ms;
};

/// Rows gathered into pages. Names are sorted, so that the order of rows does not matter.
struct SurveyData {
  std::vector<std::string> participants;
  std::vector<std::string> arms;  ///< per participant; empty where the study has one only
  std::vector<std::string> scenes;
  std::vector<std::string> techniques;
  std::vector<PageAnswer> pages;       ///< by participant, scene, page_index, repeat
  std::vector<std::string> taken_out;  ///< participants that a researcher took out
};

/// Rows of participants who were taken out are left aside. Ranks are made anew from each page's
/// order, so that dense places, competition ranks and mid-ranks all mean the same.
SurveyData gather(const std::vector<ResponseRow>& rows);

/// The same row by row: of each only what statistics need is kept.
class Gatherer {
 public:
  void add(const ResponseRow& row);
  SurveyData finish();

 private:
  struct Names {
    std::unordered_map<std::string, std::uint32_t> numbers;
    std::uint32_t number(const std::string& name);
    /// Names in order, and for each number its place there.
    std::pair<std::vector<std::string>, std::vector<std::size_t>> sorted() const;
  };
  struct Row {
    std::uint32_t participant = 0;
    std::uint32_t scene = 0;
    std::uint32_t technique = 0;
    int page_index = 0;
    int repeat = 0;
    double rank = 0.0;
    double digit = missing;
    double slot = missing;
    double weight = missing;
    double active_ms = missing;
  };
  std::vector<std::string> arms_of(const std::vector<std::string>& names) const;
  static PageAnswer page_of(const Row* first, const Row* last, std::size_t techniques);

  Names participants;
  std::map<std::uint32_t, std::string> arms;  ///< by participant, where there are several
  Names scenes;
  Names techniques;
  std::set<std::string> taken_out;
  std::vector<Row> rows;
};

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
  Table weighted_ranks;   ///< sum(w r) / sum(w) over the participant's pages
  Table weights;          ///< sum(w), 0 where no page has a weight
  Table digits;           ///< mean digit; empty unless every page was answered with digits
  Table weighted_digits;  ///< sum(w d) / sum(w); empty as `digits`
  std::size_t pages = 0;
  std::size_t tied = 0;     ///< pictures that share their rank with another, summed over pages
  std::size_t ranked = 0;   ///< pictures, summed over pages
  bool any_weight = false;  ///< otherwise every page counts 1
};

/// What a row of the table is. Pages as rows take a person's pages for so many people: tests on
/// them reject too often (van Sambeek 2007, table 4.9), so that they are only ever shown beside the
/// others.
enum class Blocks { participants, pages };

/// Of one scene, or of all where `scene` is empty. Repeated showings are left out.
ParticipantTable participant_table(const SurveyData& data, const Selection& selection,
                                   std::optional<std::size_t> scene,
                                   Blocks blocks = Blocks::participants);

}  // namespace penumbra::study::statistics
