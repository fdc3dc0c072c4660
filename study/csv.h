#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::study {

struct CsvRecord {
  std::size_t line = 0;  ///< where it begins, from 1
  std::vector<std::string> cells;
};

/// Reads RFC 4180 text record by record, so that a long file needs no second copy of itself. Line
/// feeds alone end records too, a byte order mark and empty lines are skipped. `separator` is a
/// comma unless a spreadsheet wrote a semicolon or a tab. Throws unreadable naming the line: text
/// that is not UTF-8, a quote that never closes, anything but a separator behind a closing quote.
class CsvReader {
 public:
  explicit CsvReader(std::string_view text, char separator = ',');

  /// The next record, into `record`; false at the end.
  bool next(CsvRecord& record);

 private:
  void read_record(CsvRecord& record);
  std::string cell();
  std::string quoted();

  std::string_view text;
  char separator;
  std::size_t at = 0;
  std::size_t line = 1;
};

/// All records at once.
std::vector<CsvRecord> parse_csv(std::string_view text, char separator = ',');

/// How a spreadsheet separated the cells of the first line: the one of comma, semicolon and tab
/// that makes the columns `expected` out of it; empty where none does.
std::optional<char> find_separator(std::string_view text, const std::vector<std::string>& expected);

/// "commas", "semicolons", "tabs".
std::string separator_name(char separator);

}  // namespace penumbra::study
