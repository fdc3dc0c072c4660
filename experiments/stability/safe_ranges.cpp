#include "experiments/stability/safe_ranges.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "experiments/stability/report.h"
#include "renderer/error.h"
#include "study/csv.h"

namespace penumbra::experiments::stability {
namespace {

constexpr std::size_t longest_line = 110;  // bytes

/// To two digits: a break is known no better than the halvings found it.
double rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1e", value);
  return std::atof(text);
}

/// "map_size down" is pushed downwards already; other axes say where they lead.
std::string held(const Axis& axis, const SafeRange& range) {
  if (!range.holds) return "not served";
  if (!axis.has_between()) return "all but " + axis.text(*range.ends);
  return (*range.holds < *range.ends ? "up to " : "down to ") + axis.text(rounded(*range.holds));
}

/// The name that a page shows: parameters as the request has them.
std::string name_of(const std::string& axis) {
  const auto blank = axis.rfind(' ');
  return "`" + axis.substr(0, blank) + "`";
}

std::optional<double> number_in(const study::CsvRecord& record, std::size_t column) {
  const std::string& cell = record.cells.at(column);
  if (cell.empty()) return std::nullopt;
  std::istringstream text(cell);
  double value = 0.0;
  if (!(text >> value) || !text.eof())
    throw bad_value(
        "", "line " + std::to_string(record.line) + ": a number is expected, found `" + cell + "`");
  return value;
}

std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string lines;
  std::size_t length = 0;
  for (std::string word; words >> word;) {
    const bool breaks = length > 0 && length + 1 + word.size() > longest_line;
    if (length > 0) lines += breaks ? '\n' : ' ';
    length = breaks || length == 0 ? word.size() : length + 1 + word.size();
    lines += word;
  }
  return lines + "\n";
}

std::vector<std::string> techniques_of(const std::vector<SafeRange>& ranges) {
  std::vector<std::string> names;
  for (const SafeRange& range : ranges)
    if (std::find(names.begin(), names.end(), range.technique) == names.end())
      names.push_back(range.technique);
  return names;
}

}  // namespace

SafeRange safe_range_of(const Finding& finding) {
  return {finding.technique, finding.axis,    finding.holds,
          finding.ends,      finding.refused, finding.cause};
}

std::vector<SafeRange> read_safe_ranges(const std::string& csv) {
  const auto records = study::parse_csv(csv);
  if (records.empty()) throw Error("unreadable", "the results are empty", "");
  const auto column = [&](const char* name) {
    const auto& head = records.front().cells;
    const auto found = std::find(head.begin(), head.end(), name);
    if (found == head.end())
      throw Error("unreadable", std::string("the results have no column ") + name, "");
    return static_cast<std::size_t>(found - head.begin());
  };
  const auto technique = column("technique"), axis = column("axis"), holds = column("holds");
  const auto ends = column("ends"), verdict = column("verdict"), cause = column("cause");
  std::vector<SafeRange> ranges;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const auto& record = records[i];
    if (record.cells.size() != records.front().cells.size())
      throw bad_value("", "line " + std::to_string(record.line) + ": " +
                              std::to_string(records.front().cells.size()) + " cells are expected");
    ranges.push_back({record.cells[technique], record.cells[axis], number_in(record, holds),
                      number_in(record, ends),
                      record.cells[verdict] == "refused" || record.cells[verdict] == "not served",
                      record.cells[cause]});
  }
  return ranges;
}

std::string safe_ranges_page(const std::vector<SafeRange>& ranges) {
  std::string page =
      "# Safe ranges\n\nHow far each technique holds along every axis on which something ends, as "
      "[stability "
      "measured it](stability.md).\nAxes that are not named hold to their end. *required*: the "
      "method or "
      "mathematics asks for it; *early*: the program\ncould do better, for the reason given; "
      "*open*: not "
      "explained yet.\n";
  for (const std::string& technique : techniques_of(ranges)) {
    page += "\n## " + technique + "\n\n| axis | holds | then | |\n|---|---|---|---|\n";
    for (const SafeRange& range : ranges) {
      if (range.technique != technique || !range.ends) continue;
      const Axis axis = find_axis(technique, range.axis);
      const Reason* reason = reason_of(technique, range.axis);
      std::string why = "*open*";
      if (range.refused) why = "refused";
      if (reason != nullptr) why = (reason->required ? "*required*: " : "*early*: ") + reason->why;
      page += "| " + axis.title + " (`" + range.axis + "`) | " + held(axis, range) + " | " +
              range.cause + " | " + why + " |\n";
    }
  }
  return page;
}

std::string safe_ranges_quote(const std::string& technique, const std::vector<SafeRange>& ranges) {
  std::string list;
  bool measured = false;
  for (const SafeRange& range : ranges) {
    measured = measured || range.technique == technique;
    if (range.technique != technique || !range.ends) continue;
    list += (list.empty() ? "" : ", ") + name_of(range.axis) + " " +
            held(find_axis(technique, range.axis), range);
  }
  return wrapped("**Safe ranges** ([why](../../docs/measurements/safe-ranges.md#" + technique +
                 ")): " +
                 (!measured      ? "not measured"
                  : list.empty() ? "all axes hold to their end"
                                 : list) +
                 ".");
}

}  // namespace penumbra::experiments::stability
