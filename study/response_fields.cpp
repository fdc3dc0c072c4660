#include "study/response_fields.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "renderer/error.h"

namespace penumbra::study {

namespace {

/// Spreadsheets skip blanks, and take the wide forms of East Asian keyboards for = + - @ as well.
bool is_dangerous(std::string_view cell) {
  constexpr std::string_view controls("\t\r\n\0", 4);
  if (cell.empty()) return false;
  if (controls.find(cell.front()) != std::string_view::npos) return true;
  cell.remove_prefix(std::min(cell.find_first_not_of(' '), cell.size()));
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  if (!cell.empty() && is_plain(cell.front())) return false;  // nearly every cell
  for (const std::string_view begin : {"=", "+", "-", "@", "\uFF1D", "\uFF0B", "\uFF0D", "\uFF20"})
    if (cell.starts_with(begin)) return true;
  return false;
}

/// Undoes the writer's apostrophe. A cell that began with an apostrophe itself was left alone,
/// unless a dangerous character follows it; those few lose theirs.
std::string read_text(const std::string& cell) {
  const bool guarded = cell.size() > 1 && cell.front() == '\'' && is_dangerous(cell.substr(1));
  return guarded ? cell.substr(1) : cell;
}

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

double read_number(const std::string& cell, double low, double high) {
  double value = 0.0;
  const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = result.ec == std::errc() && result.ptr == cell.data() + cell.size();
  if (!whole || !(value >= low && value <= high)) {
    throw bad_value("", "number from " + number_text(low) + " to " + number_text(high) +
                            " expected, found `" + cell + "`");
  }
  return value;
}

int read_whole(const std::string& cell, int low, int high) {
  const double value = read_number(cell, low, high);
  if (std::floor(value) != value)
    throw bad_value("", "whole number expected, found `" + cell + "`");
  return static_cast<int>(value);
}

/// As R reads truth values by itself.
std::string flag_text(bool value) {
  return value ? "TRUE" : "FALSE";
}

bool read_flag(const std::string& cell) {
  for (const char* name : {"true", "TRUE", "True", "1"}) {
    if (cell == name) return true;
  }
  for (const char* name : {"false", "FALSE", "False", "0"}) {
    if (cell == name) return false;
  }
  throw bad_value("", "true or false expected, found `" + cell + "`");
}

std::string joined(const std::vector<int>& numbers) {
  std::string text;
  for (const int number : numbers) text += (text.empty() ? "" : " ") + std::to_string(number);
  return text;
}

constexpr int max_cell_count = 1'000'000'000;

Field text_field(const char* name, const char* meaning, std::string ResponseRow::*member,
                 bool required = false) {
  return {{name, "text", meaning},
          required,
          [member](const ResponseRow& row) { return csv_text(row.*member); },
          [member, required](ResponseRow& row, const std::string& cell) {
            if (required && cell.empty()) throw bad_value("", "may not be empty");
            row.*member = read_text(cell);
          }};
}

Field count_field(const char* name, const char* meaning, int ResponseRow::*member) {
  return {{name, "integer", meaning},
          false,
          [member](const ResponseRow& row) { return std::to_string(row.*member); },
          [member](ResponseRow& row, const std::string& cell) {
            row.*member = cell.empty() ? 0 : read_whole(cell, 0, max_cell_count);
          }};
}

Field integer_field(const char* name, const char* meaning, std::optional<int> ResponseRow::*member,
                    int low, int high, bool required = false) {
  return {{name, "integer", meaning},
          required,
          [member](const ResponseRow& row) {
            return row.*member ? std::to_string(*(row.*member)) : std::string();
          },
          [member, low, high](ResponseRow& row, const std::string& cell) {
            if (!cell.empty()) row.*member = read_whole(cell, low, high);
          }};
}

Field real_field(const char* name, const char* meaning,
                 std::optional<double> ResponseRow::*member) {
  return {{name, "number", meaning},
          false,
          [member](const ResponseRow& row) {
            return row.*member ? number_text(*(row.*member)) : std::string();
          },
          [member](ResponseRow& row, const std::string& cell) {
            if (!cell.empty()) row.*member = read_number(cell, 0.0, max_ms);
          }};
}

Field rank_field() {
  return {
      {"rank_1_is_most_realistic", "number", "mid-rank on the page: equal pictures share the mean"},
      true,
      [](const ResponseRow& row) { return number_text(row.rank); },
      [](ResponseRow& row, const std::string& cell) { row.rank = read_number(cell, 1.0, 1e6); }};
}

Field best_digit_field() {
  Field field =
      integer_field("best_digit", "where digits were typed: the one, 1 or 9, of most realistic",
                    &ResponseRow::best_digit, 1, 9);
  field.read = [read = field.read](ResponseRow& row, const std::string& cell) {
    read(row, cell);
    if (row.best_digit && *row.best_digit != 1 && *row.best_digit != 9)
      throw bad_value("", "1 or 9 expected, found `" + cell + "`");
  };
  return field;
}

/// What is written and never read back: nothing that is computed from rows needs it.
Field page_field(const char* name, const char* type, const char* meaning,
                 std::function<std::string(const PageFacts&)> write) {
  return {{name, type, meaning},
          false,
          [write = std::move(write)](const ResponseRow& row) {
            return row.page ? write(*row.page) : std::string();
          },
          [](ResponseRow&, const std::string&) {}};
}

Field size_field(const char* name, const char* meaning, std::optional<PageSize> Observations::*size,
                 double PageSize::*side) {
  return page_field(name, "number", meaning, [size, side](const PageFacts& page) {
    return page.seen.*size ? number_text((*(page.seen.*size)).*side) : std::string();
  });
}

Field swapped_field() {
  return {{"swapped_direction", "boolean",
           "the button that turns the order round was used; ranks are those after it"},
          false,
          [](const ResponseRow& row) {
            return row.swapped_direction ? std::string(flag_text(*row.swapped_direction))
                                         : std::string();
          },
          [](ResponseRow& row, const std::string& cell) {
            if (!cell.empty()) row.swapped_direction = read_flag(cell);
          }};
}

Field included_field() {
  return {{"included", "boolean", "false where a researcher took the participant out"},
          false,
          [](const ResponseRow& row) { return flag_text(row.included); },
          [](ResponseRow& row, const std::string& cell) {
            row.included = cell.empty() || read_flag(cell);
          }};
}

/// Who saw which picture of what.
std::vector<Field> subject_fields() {
  using Row = ResponseRow;
  return {
      text_field("study", "id of the study", &Row::study),
      text_field("study_hash", "SHA-256 of the study as it was published", &Row::study_hash),
      text_field("participant", "pseudonym", &Row::participant, true),
      text_field("arm",
                 "way of giving ranks that the participant was assigned to; empty where the study "
                 "has one only",
                 &Row::arm),
      count_field("page_index", "position at which the participant saw the page, from 0",
                  &Row::page_index),
      count_field("repeat", "0 first showing, 1 second, which measures reliability only",
                  &Row::repeat),
      text_field("scene", "the page's id: its scene unless the study names it", &Row::scene, true),
      text_field("technique", "the picture's id: its technique unless the study names it",
                 &Row::technique, true),
      text_field("preset",
                 "technique or preset that was rendered; empty for a picture of one's own",
                 &Row::preset),
      text_field("own_picture", "SHA-256 of the picture that was uploaded; empty for renders",
                 &Row::own_picture),
      text_field("parameters_hash", "hash of the parameters that the study gave the picture",
                 &Row::parameters_hash),
  };
}

/// What was said of the picture and its page, and how long that took.
std::vector<Field> answer_fields() {
  using Row = ResponseRow;
  return {
      integer_field("slot", "position on the page, from 0", &Row::slot, 0, max_cell_count),
      rank_field(),
      integer_field("shelf_0_is_most_realistic", "shelf the picture was put on", &Row::shelf, 0,
                    max_cell_count),
      integer_field("digit_as_typed", "1 to 9, where digits were typed", &Row::digit, 1, 9),
      best_digit_field(),
      integer_field("difficulty_1_hard_to_see_5_easy", "answer about the page", &Row::difficulty, 1,
                    5, true),
      real_field("weight", "of the page in weighted means; the difficulty unless given",
                 &Row::weight),
      real_field("active_ms", "milliseconds with the page in front and focused", &Row::active_ms),
      real_field("total_ms", "milliseconds from showing the page to its answer", &Row::total_ms),
      integer_field("enlarged", "how often a picture of the page was enlarged", &Row::enlarged, 0,
                    max_cell_count),
      integer_field("flipped", "how often two pictures were flipped in place", &Row::flipped, 0,
                    max_cell_count),
      swapped_field(),
      text_field("flags", "names of the participant's flags, separated by blanks", &Row::flags),
      included_field(),
      text_field("started_at", "when the participant entered, ISO 8601, UTC", &Row::started_at),
      text_field("answered_at", "when the server stored the answer, ISO 8601, UTC",
                 &Row::answered_at),
  };
}

/// What was noted of the page besides.
std::vector<Field> page_fields() {
  return {
      page_field("participant_completed", "boolean",
                 "TRUE where the participant finished the study",
                 [](const PageFacts& page) { return flag_text(page.participant_completed); }),
      page_field("answers_before", "integer", "answers to the page that this one replaced",
                 [](const PageFacts& page) { return std::to_string(page.answers_before); }),
      page_field("order_shown", "text", "slots in the order in which the page showed them",
                 [](const PageFacts& page) { return joined(page.seen.order_shown); }),
      page_field("turns", "integer", "how often the view was turned, on a page with an orbit",
                 [](const PageFacts& page) { return std::to_string(page.seen.turns); }),
      page_field("frames_seen", "integer", "views that were seen, on a page with an orbit",
                 [](const PageFacts& page) { return std::to_string(page.seen.frames_seen); }),
      page_field("swaps", "integer", "how often the button that turns the order round was used",
                 [](const PageFacts& page) { return std::to_string(page.seen.swaps); }),
      page_field("all_same", "boolean", "TRUE where the answer was that all look the same",
                 [](const PageFacts& page) { return flag_text(page.seen.all_same); }),
      page_field("blurs", "integer", "how often the window lost focus",
                 [](const PageFacts& page) { return std::to_string(page.seen.blurs); }),
      page_field("load_failures", "integer", "how often a picture failed to load",
                 [](const PageFacts& page) { return std::to_string(page.seen.load_failures); }),
      size_field("window_width", "CSS pixels", &Observations::window, &PageSize::width),
      size_field("window_height", "CSS pixels", &Observations::window, &PageSize::height),
      size_field("screen_width", "CSS pixels", &Observations::screen, &PageSize::width),
      size_field("screen_height", "CSS pixels", &Observations::screen, &PageSize::height),
      page_field("device_pixel_ratio", "number", "device pixels per CSS pixel",
                 [](const PageFacts& page) {
                   const auto& ratio = page.seen.device_pixel_ratio;
                   return ratio ? number_text(*ratio) : std::string();
                 }),
      page_field("page_started_at", "text", "by the browser's clock",
                 [](const PageFacts& page) { return csv_text(page.seen.started_at); }),
      page_field("page_answered_at", "text", "by the browser's clock",
                 [](const PageFacts& page) { return csv_text(page.seen.answered_at); }),
  };
}

}  // namespace

const std::vector<Field>& response_fields() {
  static const std::vector<Field> list = [] {
    std::vector<Field> all = subject_fields();
    for (const auto& more : {answer_fields(), page_fields()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return list;
}

const std::vector<Column>& response_columns() {
  static const std::vector<Column> columns = [] {
    std::vector<Column> list;
    for (const Field& field : response_fields()) list.push_back(field.column);
    return list;
  }();
  return columns;
}

std::string csv_text(std::string_view cell) {
  std::string text = is_dangerous(cell) ? "'" + std::string(cell) : std::string(cell);
  const auto needs_quotes = [](char c) { return c == ',' || c == '"' || c == '\r' || c == '\n'; };
  if (std::none_of(text.begin(), text.end(), needs_quotes)) return text;
  std::string quoted = "\"";
  for (const char character : text) {
    if (character == '"') quoted += '"';
    quoted += character;
  }
  return quoted + "\"";
}

std::string response_header() {
  std::string text;
  for (const Field& field : response_fields())
    text += (text.empty() ? "" : ",") + field.column.name;
  return text + "\r\n";
}

void append_response(const ResponseRow& row, std::string& text) {
  bool first = true;
  for (const Field& field : response_fields()) {
    if (!first) text += ',';
    first = false;
    text += field.write(row);
  }
  text += "\r\n";
}

std::string write_responses(const std::vector<ResponseRow>& rows) {
  std::string text = response_header();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    append_response(rows[i], text);
    // Room for all, judged by the first: growing step by step would keep two copies for a moment.
    if (i == 0) text.reserve(text.size() * (rows.size() + 1));
  }
  return text;
}

}  // namespace penumbra::study
