#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "study/checks.h"
#include "study/responses.h"

/// The tables of export.zip beside responses.csv. Each is written piece by piece, so that a study
/// of any size leaves in little memory.
namespace penumbra::study {

/// pairs.csv, as pwcmp's pw_scale_table reads it: every pair of pictures of a page in a row. A tie
/// goes to A and B in turn, so that sums over participants count it half to each. Second showings
/// and people who were taken out are left out.
class PairsTable {
 public:
  static std::string header();
  /// Rows of one page.
  void append(const std::vector<ResponseRow>& page, std::string& text);

 private:
  std::map<std::tuple<std::string, std::string, std::string>, bool> next_tie;
};

/// responses_wide.csv: a row per participant, a column per page and picture with its rank, and one
/// per page with its difficulty. Columns come from the study, so that all files of it are alike.
class WideTable {
 public:
  explicit WideTable(const Study& study);
  std::vector<Column> columns() const;
  std::string header() const;
  /// Rows of one participant, by page; no page is empty.
  void append(const std::vector<std::vector<ResponseRow>>& answered, std::string& text) const;

 private:
  struct PageColumns {
    std::string id;  ///< with ".again" for the second showing
    std::vector<std::string> pictures;
  };
  std::vector<PageColumns> pages;
};

/// One participant as participants.csv has it.
struct ParticipantRow {
  std::string participant;
  std::size_t place = 0;
  std::string arm;
  std::string entered_at;
  std::string seen_at;
  std::string completed_at;  ///< empty: stopped early, or is still at it
  std::string outcome;       ///< started, completed or screened_out
  std::size_t pages_answered = 0;
  std::size_t pages = 0;
  std::string language;
  std::string consent_version;
  bool test = false;  ///< a researcher's preview
  bool excluded = false;
  std::string exclusion_reason;
  std::string flags;  ///< names separated by blanks
  PersonChecks checks;
  nlohmann::json parameters = nlohmann::json::object();  ///< of the link
  nlohmann::json details = nlohmann::json::object();     ///< answers about the person
};

/// participants.csv: a row each, with a column for every parameter of the link and every question
/// about the person that the study has.
class ParticipantsTable {
 public:
  explicit ParticipantsTable(const Study& study);
  std::string header() const;
  void append(const ParticipantRow& row, std::string& text) const;
  std::vector<Column> columns() const;

 private:
  std::vector<std::string> parameters;
  std::vector<std::string> questions;  ///< about the person
  std::vector<std::string> checked;    ///< pages with an expected answer
};

/// codebook.csv: every file of the export and every column of its tables.
std::string write_codebook(const Study& study);

/// Files of the export that are no tables, with what they are.
const std::vector<std::pair<std::string, std::string>>& export_documents();

}  // namespace penumbra::study
