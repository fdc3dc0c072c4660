#include "study/measures.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "renderer/error.h"
#include "study/csv.h"

namespace penumbra::study {

namespace {

std::optional<std::size_t> column_of(const CsvRecord& header, const std::string& name) {
  const auto found = std::find(header.cells.begin(), header.cells.end(), name);
  if (found == header.cells.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.cells.begin());
}

std::size_t required_column(const CsvRecord& header, const std::string& name) {
  const auto found = column_of(header, name);
  if (!found) throw unreadable("the header has no column `" + name + "`", name);
  return *found;
}

double number_of(const std::string& cell, std::size_t line, const std::string& name) {
  double value = 0.0;
  const auto end = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (end.ec != std::errc() || end.ptr != cell.data() + cell.size() || !std::isfinite(value))
    throw unreadable("line " + std::to_string(line) + ", column " + name +
                         ": number expected, found `" + cell + "`",
                     name);
  return value;
}

}  // namespace

const std::vector<Measure>& known_measures() {
  static const std::vector<Measure> list{
      {frame_time, "frame time (ms, median)", true, false},
      {"rms_y", "error, RMS luminance (levels of 0 to 255)", false, false},
      {"flip", "error, FLIP (0 to 1)", false, false},
      {"ssim", "similarity, SSIM (up to 1)", false, true},
      {"psnr", "similarity, PSNR (dB)", false, true},
      {"visibility_rms", "error of visibility, RMS (0 to 1)", false, false}};
  return list;
}

std::optional<double> Measures::find(const std::string& measure, const std::string& scene,
                                     const std::string& technique) const {
  const auto all = values.find(measure);
  if (all == values.end()) return std::nullopt;
  const auto found = all->second.find({scene, technique});
  return found == all->second.end() ? std::nullopt : std::optional<double>(found->second);
}

Measures parse_measures(std::string_view text) {
  const auto records = parse_csv(text);
  if (records.empty()) throw unreadable("the file has no header");
  const CsvRecord& header = records.front();
  const std::size_t scene = required_column(header, "scene");
  const std::size_t technique = required_column(header, "technique");
  Measures measures;
  bool any = false;
  for (const Measure& measure : known_measures()) {
    const auto column = column_of(header, measure.name);
    if (!column) continue;
    any = true;
    for (std::size_t i = 1; i < records.size(); ++i) {
      const CsvRecord& record = records[i];
      if (record.cells.size() != header.cells.size())
        throw unreadable("line " + std::to_string(record.line) + ": " +
                         std::to_string(record.cells.size()) + " cells, the header has " +
                         std::to_string(header.cells.size()));
      const std::string& cell = record.cells[*column];
      if (cell.empty()) continue;
      const double value = number_of(cell, record.line, measure.name);
      if (!measures.values[measure.name]
               .emplace(std::make_pair(record.cells[scene], record.cells[technique]), value)
               .second)
        throw unreadable("line " + std::to_string(record.line) + ": `" + record.cells[technique] +
                             "` in `" + record.cells[scene] +
                             "` was measured above already; give one size of pictures only",
                         "technique");
    }
  }
  if (!any) throw unreadable("the header has no measure, e.g. rms_y or " + std::string(frame_time));
  return measures;
}

}  // namespace penumbra::study
