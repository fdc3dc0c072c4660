#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::study {

struct CsvRecord {
  std::size_t line = 0;  ///< where it begins, from 1
  std::vector<std::string> cells;
};

/// Splits RFC 4180 text into records. Line feeds alone end records too, a byte order mark and empty
/// lines are skipped. Throws unreadable naming the line: text that is not UTF-8, a quote that never
/// closes, anything but a comma behind a closing quote.
std::vector<CsvRecord> parse_csv(std::string_view text);

}  // namespace penumbra::study
