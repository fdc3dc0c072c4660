#include "study/csv.h"

#include <algorithm>

#include "figures/text.h"
#include "renderer/error.h"

namespace penumbra::study {

namespace {

Error at_line(std::size_t line, const std::string& message) {
  return unreadable("line " + std::to_string(line) + ": " + message);
}

void check_utf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = figures::utf8_length(text.substr(at));
    if (length == 0) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
      throw at_line(static_cast<std::size_t>(line), "not UTF-8");
    }
    at += length;
  }
}

}  // namespace

CsvReader::CsvReader(std::string_view text_, char separator_) : text(text_), separator(separator_) {
  check_utf8(text);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
}

bool CsvReader::next(CsvRecord& record) {
  while (at < text.size()) {
    read_record(record);
    if (record.cells.size() != 1 || !record.cells.front().empty()) return true;
  }
  return false;
}

void CsvReader::read_record(CsvRecord& record) {
  record.line = line;
  record.cells.clear();
  record.cells.push_back(cell());
  while (at < text.size() && text[at] == separator) {
    ++at;
    record.cells.push_back(cell());
  }
  if (at < text.size() && text[at] == '\r') ++at;
  if (at < text.size()) {
    if (text[at] != '\n') throw at_line(line, "unexpected character after a cell");
    ++at;
    ++line;
  }
}

std::string CsvReader::cell() {
  if (at < text.size() && text[at] == '"') return quoted();
  const char ends[] = {separator, '\r', '\n', '"'};
  const std::size_t end = std::min(text.find_first_of(std::string_view(ends, 4), at), text.size());
  if (end < text.size() && text[end] == '"') throw at_line(line, "quote inside a bare cell");
  const std::string_view content = text.substr(at, end - at);
  at = end;
  return std::string(content);
}

std::string CsvReader::quoted() {
  const std::size_t first_line = line;
  std::string content;
  for (++at; at < text.size(); ++at) {
    if (text[at] == '"') {
      ++at;
      if (at >= text.size() || text[at] != '"') return content;
    }
    line += text[at] == '\n' ? 1 : 0;
    content += text[at];
  }
  throw at_line(first_line, "a quote never closes");
}

std::vector<CsvRecord> parse_csv(std::string_view text, char separator) {
  std::vector<CsvRecord> records;
  CsvReader reader(text, separator);
  for (CsvRecord record; reader.next(record);) records.push_back(record);
  return records;
}

std::optional<char> find_separator(std::string_view text,
                                   const std::vector<std::string>& expected) {
  const std::string_view first_line = text.substr(0, text.find('\n'));
  for (const char separator : {',', ';', '\t'}) {
    CsvRecord header;
    if (!CsvReader(first_line, separator).next(header)) continue;
    const bool all = std::all_of(expected.begin(), expected.end(), [&](const std::string& name) {
      return std::find(header.cells.begin(), header.cells.end(), name) != header.cells.end();
    });
    if (all) return separator;
  }
  return std::nullopt;
}

std::string separator_name(char separator) {
  return separator == ',' ? "commas" : separator == ';' ? "semicolons" : "tabs";
}

}  // namespace penumbra::study
