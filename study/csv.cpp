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

class Reader {
 public:
  explicit Reader(std::string_view text_) : text(text_) {}

  bool done() const { return at >= text.size(); }

  CsvRecord record() {
    CsvRecord result{line, {}};
    result.cells.push_back(cell());
    while (!done() && text[at] == ',') {
      ++at;
      result.cells.push_back(cell());
    }
    if (!done() && text[at] == '\r') ++at;
    if (!done()) {
      if (text[at] != '\n') throw at_line(line, "unexpected character after a cell");
      ++at;
      ++line;
    }
    return result;
  }

 private:
  std::string cell() {
    if (!done() && text[at] == '"') return quoted();
    const std::size_t end = std::min(text.find_first_of(",\r\n\"", at), text.size());
    if (end < text.size() && text[end] == '"') throw at_line(line, "quote inside a bare cell");
    const std::string_view content = text.substr(at, end - at);
    at = end;
    return std::string(content);
  }

  std::string quoted() {
    const std::size_t first_line = line;
    std::string content;
    for (++at; !done(); ++at) {
      if (text[at] == '"') {
        ++at;
        if (done() || text[at] != '"') return content;
      }
      line += text[at] == '\n' ? 1 : 0;
      content += text[at];
    }
    throw at_line(first_line, "a quote never closes");
  }

  std::string_view text;
  std::size_t at = 0;
  std::size_t line = 1;
};

}  // namespace

std::vector<CsvRecord> parse_csv(std::string_view text) {
  check_utf8(text);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<CsvRecord> records;
  Reader reader(text);
  while (!reader.done()) {
    CsvRecord record = reader.record();
    if (record.cells.size() == 1 && record.cells.front().empty()) continue;
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace penumbra::study
