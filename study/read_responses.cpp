#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>

#include "renderer/error.h"
#include "study/csv.h"
#include "study/response_fields.h"

namespace penumbra::study {

namespace {

/// What the header holds, for a message: its first cells.
std::string seen_columns(const CsvRecord& header, char separator) {
  constexpr std::size_t most = 5;
  std::string text = "; separated by " + separator_name(separator) + " it holds ";
  for (std::size_t i = 0; i < std::min(most, header.cells.size()); ++i) {
    text += (i > 0 ? ", `" : "`") + header.cells[i].substr(0, 60) + "`";
  }
  return text + (header.cells.size() > most ? ", ..." : "");
}

/// Index of the cell for every field, npos where the file has no such column.
std::vector<std::size_t> find_columns(const CsvRecord& header, char separator) {
  std::vector<std::size_t> cells;
  for (const Field& field : response_fields()) {
    const std::string& name = field.column.name;
    const auto found = std::find(header.cells.begin(), header.cells.end(), name);
    if (found == header.cells.end()) {
      if (field.required) {
        throw unreadable(
            "the header has no column `" + name + "`" + seen_columns(header, separator), name);
      }
      cells.push_back(std::string::npos);
      continue;
    }
    if (std::find(found + 1, header.cells.end(), name) != header.cells.end()) {
      throw unreadable("the header has the column `" + name + "` twice", name);
    }
    cells.push_back(static_cast<std::size_t>(found - header.cells.begin()));
  }
  return cells;
}

/// A decimal comma as a point. Where commas separate cells they are no decimal signs.
std::string decimal_point(std::string cell, char separator) {
  if (separator != ',' && std::count(cell.begin(), cell.end(), ',') == 1) {
    cell[cell.find(',')] = '.';
  }
  return cell;
}

ResponseRow read_row(const CsvRecord& record, const std::vector<std::size_t>& cells,
                     char separator) {
  ResponseRow row;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] == std::string::npos) continue;
    const std::string& name = response_fields()[i].column.name;
    try {
      const std::string& cell = record.cells[cells[i]];
      const bool text = response_fields()[i].column.type == "text";
      response_fields()[i].read(row, text ? cell : decimal_point(cell, separator));
    } catch (const Error& error) {
      throw unreadable(
          "line " + std::to_string(record.line) + ", column " + name + ": " + error.what(), name);
    }
  }
  return row;
}

/// Pictures seen so far, each on one page of one participant. Names are kept once and numbered.
class DuplicateCheck {
 public:
  bool is_new(const ResponseRow& row) {
    const Key key{number(row.participant), number(row.scene), number(row.technique),
                  static_cast<std::uint32_t>(row.page_index),
                  static_cast<std::uint32_t>(row.repeat)};
    return seen.insert(key).second;
  }

 private:
  using Key = std::array<std::uint32_t, 5>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::size_t hash = 0;
      for (const std::uint32_t part : key) hash = (hash ^ part) * 0x9E3779B97F4A7C15ull;
      return hash ^ (hash >> 32);
    }
  };

  std::uint32_t number(const std::string& name) {
    return names.try_emplace(name, static_cast<std::uint32_t>(names.size())).first->second;
  }

  std::unordered_map<std::string, std::uint32_t> names;
  std::unordered_set<Key, Hash> seen;
};

}  // namespace

ResponseFormat each_response(std::string_view text,
                             const std::function<void(const ResponseRow&)>& visit,
                             std::optional<char> separator) {
  std::vector<std::string> required;
  for (const Field& field : response_fields()) {
    if (field.required) required.push_back(field.column.name);
  }
  if (!separator) separator = find_separator(text, required);
  ResponseFormat format{separator.value_or(','), 0};
  CsvReader reader(text, format.separator);
  CsvRecord header;
  if (!reader.next(header)) throw unreadable("the file has no header");
  const auto cells = find_columns(header, format.separator);
  DuplicateCheck duplicates;
  ResponseRow row;
  for (CsvRecord record; reader.next(record);) {
    if (record.cells.size() != header.cells.size()) {
      throw unreadable("line " + std::to_string(record.line) + ": " +
                       std::to_string(record.cells.size()) + " cells separated by " +
                       separator_name(format.separator) + ", the header has " +
                       std::to_string(header.cells.size()));
    }
    row = read_row(record, cells, format.separator);
    if (!duplicates.is_new(row)) {
      throw unreadable("line " + std::to_string(record.line) + ", column technique: `" +
                           row.technique + "` stands twice on this page of `" + row.participant +
                           "`",
                       "technique");
    }
    ++format.rows;
    visit(row);
  }
  return format;
}

std::vector<ResponseRow> parse_responses(std::string_view text, std::optional<char> separator) {
  std::vector<ResponseRow> rows;
  each_response(
      text, [&](const ResponseRow& row) { rows.push_back(row); }, separator);
  return rows;
}

}  // namespace penumbra::study
