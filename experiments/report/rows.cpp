#include "experiments/report/rows.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>

#include "renderer/error.h"
#include "scenes/json_text.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;

struct Column {
  const char* name;  ///< in the CSV
  const char* key;   ///< in a row
  const char* head;  ///< in the report's table; null: not there
  int decimals = 2;
  bool optional = false;  ///< in the CSV only where any row has it
};

constexpr Column columns[] = {
    {"scene", "scene", "scene"},
    {"technique", "name", "technique"},
    {"size", "width", "size", 0},
    {"status", "status", "status"},
    {"parameters", "given", nullptr},
    {"frame_ms_median", "frame_ms", "frame ms", 3},
    {"frame_ms_p95", "p95_ms", nullptr},
    {"spread", "spread", "spread", 3},
    {"frames", "frames", "frames", 0},
    {"settled", "settled", nullptr},
    {"frame_ms_none_median", "none_ms", nullptr},
    {"frame_ms_over_none", "over_none", "over none", 2},
    {"create_ms", "create_ms", nullptr},
    {"memory_over_none_bytes", "memory_bytes", "bytes over none", 0},
    {"vertices", "vertices", nullptr},
    {"primitives", "primitives", "primitives", 0},
    {"geometry_primitives", "geometry_primitives", nullptr},
    {"fragments", "fragments", "fragments", 0},
    {"compute", "compute", nullptr},
    {"rms_y", "rms_y", "rms_y", 3},
    {"flip", "flip", "flip", 4},
    {"visibility_rms", "visibility_rms", "visibility rms", 4},
    {"false_shadow", "false_shadow", "false shadow", 4},
    {"missing_shadow", "missing_shadow", "missing shadow", 4},
    {"perceived", "perceived", "mean rank", 2, true},
};

bool any_has(const std::vector<json>& rows, const char* key) {
  return std::any_of(rows.begin(), rows.end(), [&](const json& row) { return row.contains(key); });
}

std::string text_of(const json& row, const char* key) {
  if (!row.contains(key) || row.at(key).is_null()) return {};
  const json& value = row.at(key);
  return value.is_string() ? value.get<std::string>() : scenes::json_text(value);
}

}  // namespace

double sum_over_passes(const json& row, const std::string& pass, const char* key) {
  double sum = 0.0;
  for (const json& each : row.at("passes"))
    if (each.at("name") == pass) sum += each.at(key).get<double>();
  return sum;
}

bool is_done(const json& row) {
  return row.at("status") == "done";
}

double number_of(const json& row, const char* key) {
  return row.contains(key) && row.at(key).is_number() ? row.at(key).get<double>()
                                                      : std::numeric_limits<double>::quiet_NaN();
}

std::string results_csv(const std::vector<json>& rows) {
  std::vector<const Column*> written;
  std::vector<std::string> names;
  for (const Column& column : columns) {
    if (column.optional && !any_has(rows, column.key)) continue;
    written.push_back(&column);
    names.emplace_back(column.name);
  }
  names.emplace_back("error");
  std::string csv = csv_line(names);
  for (const json& row : rows) {
    std::vector<std::string> cells;
    for (const Column* column : written) cells.push_back(text_of(row, column->key));
    cells.push_back(is_done(row) ? "" : text_of(row.at("error"), "message"));
    csv += csv_line(cells);
  }
  return csv;
}

void add_rows(Page& page, const std::vector<json>& rows) {
  std::vector<const Column*> shown;
  std::vector<std::string> heads;
  for (const Column& column : columns)
    if (column.head != nullptr && any_has(rows, column.key)) {
      shown.push_back(&column);
      heads.emplace_back(column.head);
    }
  heads.emplace_back("why it failed");
  std::vector<std::vector<Cell>> cells;
  for (const json& row : rows) {
    auto& line = cells.emplace_back();
    for (const Column* column : shown) {
      const double number = number_of(row, column->key);
      if (std::isfinite(number))
        line.emplace_back(number, column->decimals);
      else
        line.emplace_back(text_of(row, column->key));
    }
    line.emplace_back(is_done(row) ? "" : text_of(row.at("error"), "message"));
  }
  page.table("Every run. A click on a heading sorts.", heads, cells);
}

void add_facts(Page& page, const json& device, const std::string& command,
               const std::vector<json>& rows) {
  const auto failed =
      std::count_if(rows.begin(), rows.end(), [](const json& row) { return !is_done(row); });
  const auto unsettled = std::count_if(rows.begin(), rows.end(), [](const json& row) {
    return is_done(row) && !row.at("settled").get<bool>();
  });
  const auto now = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  const std::chrono::year_month_day date(now);
  page.facts({{"Device", text_of(device, "name") + " (" + text_of(device, "type") + ")"},
              {"Driver", text_of(device, "driver")},
              {"Command", command},
              {"Written", std::to_string(int(date.year())) + "-" +
                              std::to_string(100 + unsigned(date.month())).substr(1) + "-" +
                              std::to_string(100 + unsigned(date.day())).substr(1)},
              {"Runs", std::to_string(rows.size()) + ", of which " + std::to_string(failed) +
                           " failed and " + std::to_string(unsettled) +
                           " were timed at clocks that were not up"}});
  page.paragraph(
      "A frame's time is the median of the device's own clock over the frames counted in its row; "
      "spread is half the distance between quartiles over the median. A run of one frame has no "
      "spread: the frame took too long to draw again. Ratios are to the same view without shadows, "
      "timed at most 20 seconds before. Counters and bytes are of one frame. Between devices and "
      "days compare ratios, not times.");
}

void write_report_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  out.close();
  if (!out) throw Error("unwritable", "cannot write " + file.string(), "out");
}

std::string file_name(const std::string& text) {
  std::string name;
  for (const char c : text)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '.' ? c : '-';
  return name;
}

}  // namespace penumbra::experiments
