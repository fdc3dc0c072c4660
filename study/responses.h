#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/answer.h"
#include "study/enrolment.h"
#include "study/study.h"

namespace penumbra::study {

/// What every picture of a page shares and only exports need.
struct PageFacts {
  Observations seen;
  bool participant_completed = false;
  int answers_before = 0;  ///< answers to this page that this one replaced
};

/// A row of responses.csv: one picture on one page of one participant.
struct ResponseRow {
  std::string study;
  std::string study_hash;
  std::string participant;  ///< pseudonym
  std::string arm;          ///< of the study; empty where it has one way of giving ranks only
  int page_index = 0;       ///< position at which the participant saw the page, from 0
  int repeat = 0;           ///< 0 first showing, 1 second
  std::string scene;        ///< the page's id, which is the scene's unless the study says otherwise
  std::string technique;    ///< the picture's id in the study
  std::string preset;       ///< technique or preset that was rendered; empty for one's own picture
  std::string own_picture;  ///< SHA-256 of the picture that was uploaded; empty for renders
  std::string parameters_hash;
  std::optional<int> slot;  ///< position on the page, from 0
  double rank = 0.0;        ///< rank_1_is_most_realistic, mid-rank where equal
  std::optional<int> shelf;
  std::optional<int> digit;       ///< as typed
  std::optional<int> best_digit;  ///< where digits were typed: 1 or 9, the most realistic
  std::optional<int> difficulty;
  std::optional<double> weight;
  std::optional<double> active_ms;
  std::optional<double> total_ms;
  std::optional<int> enlarged;
  std::optional<int> flipped;
  std::optional<bool> swapped_direction;
  std::string flags;  ///< names separated by blanks
  bool included = true;
  std::string started_at;
  std::string answered_at;
  std::shared_ptr<const PageFacts> page;  ///< empty where rows were read from a file
};

/// Rows of one answered page. `page_index` is the position in the plan.
std::vector<ResponseRow> response_rows(const Study& study, const std::string& hash,
                                       const std::string& participant, const Arm& arm,
                                       const PlannedPage& planned, int page_index,
                                       const Answer& answer, const std::string& answered_at);

/// Name and meaning of every column, in the order of the file: header, writer, parser and
/// codebook.csv are derived from it.
struct Column {
  std::string name;
  std::string type;
  std::string meaning;
};
const std::vector<Column>& response_columns();

/// RFC 4180 (CRLF), UTF-8. Text cells that begin with = + - @ (blanks before it or not, or in its
/// wide form), tab, a line's end or NUL get a leading apostrophe, so that no spreadsheet runs them.
std::string write_responses(const std::vector<ResponseRow>& rows);

/// The same piece by piece, for files that are not held in memory.
std::string response_header();
void append_response(const ResponseRow& row, std::string& text);

/// One cell as the writer puts it: quoted where needed, neutralised where dangerous.
std::string csv_text(std::string_view cell);

/// How responses were read.
struct ResponseFormat {
  char separator = ',';
  std::size_t rows = 0;
};

/// Reads what write_responses wrote, and any CSV with at least the columns participant, scene,
/// technique, rank_1_is_most_realistic and difficulty_1_hard_to_see_5_easy, in any order, and calls
/// `visit` with each row; further columns are ignored, a byte order mark and bare line feeds
/// accepted. Cells may also be separated by semicolons or tabs, as spreadsheets of many countries
/// write them: what the header shows, unless `separator` says it; numbers may then have decimal
/// commas. Throws unreadable whose field is the column and whose message gives line and column.
ResponseFormat each_response(std::string_view text,
                             const std::function<void(const ResponseRow&)>& visit,
                             std::optional<char> separator = std::nullopt);

/// All rows at once.
std::vector<ResponseRow> parse_responses(std::string_view text,
                                         std::optional<char> separator = std::nullopt);

}  // namespace penumbra::study
