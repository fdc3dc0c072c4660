#include "experiments/claims/report.h"

#include <cmath>
#include <cstdio>
#include <map>

#include "experiments/report/page.h"
#include "experiments/report/rows.h"
#include "renderer/error.h"

namespace penumbra::experiments::claims {
namespace {

using nlohmann::json;

constexpr const char* method =
    "Every claim is a published statement, a set-up and a rule. The parts of a rule are separated "
    "by semicolons: reproduced is all of them, in part is some. A claim that does not reproduce is "
    "a finding. Times on a processor are told and not judged. S0 is van Sambeek 2007, S1 Alecu "
    "2014, S2 Coleman 2006, S3 Adorjan 2013, S4 Sindholt 2005.";

std::string short_text(double value) {
  if (!std::isfinite(value)) return "none";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  // Counts and bytes are whole: all their digits are told.
  if (value == std::floor(value) && std::abs(value) < 1e15)
    std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

std::string numbers_of(const Judged& judged) {
  std::string text;
  for (const auto& [name, value] : judged.outcome.numbers)
    text += (text.empty() ? "" : "; ") + name + " " + short_text(value);
  return text;
}

std::string claims_csv(const std::vector<Judged>& list) {
  std::string csv = csv_line({"id", "source", "statement", "rule", "verdict", "numbers", "note"});
  for (const Judged& judged : list) {
    std::string numbers;
    for (const auto& [name, value] : judged.outcome.numbers)
      numbers += (numbers.empty() ? "" : "; ") + name + "=" + exact(value);
    csv += csv_line({judged.claim->id, judged.claim->source, judged.claim->statement,
                     judged.claim->rule, name_of(judged.verdict), numbers, judged.outcome.note});
  }
  return csv;
}

std::string counts_of(const std::vector<Judged>& list) {
  std::map<Verdict, std::size_t> counts;
  for (const Judged& judged : list) ++counts[judged.verdict];
  std::string text = std::to_string(list.size()) + " claims:";
  for (const auto& [verdict, count] : counts)
    text += (text.back() == ':' ? " " : ", ") + std::to_string(count) + " " + name_of(verdict);
  return text + ".";
}

std::string device_text(const json& device) {
  if (device.is_null()) return "none was needed";
  return device.at("name").get<std::string>() + ", " + device.at("driver").get<std::string>();
}

/// Text of a cell of a Markdown table.
std::string cell_of(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

}  // namespace

void make_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder / "figures", failed);
  if (failed)
    throw Error("unwritable", "cannot make " + folder.string() + ": " + failed.message(), "out");
}

std::vector<std::string> write_report(const std::filesystem::path& folder, const json& device,
                                      const std::string& command, const std::vector<Judged>& list,
                                      const std::vector<json>& rows) {
  std::vector<std::string> files{"results.csv", "runs.csv", "report.html"};
  Page page("Published claims");
  if (device.is_null())
    page.facts({{"Device", device_text(device)}, {"Command", command}});
  else
    add_facts(page, device, command, rows);
  page.paragraph(method);
  page.paragraph(counts_of(list));
  std::vector<std::vector<Cell>> cells;
  for (const Judged& judged : list)
    cells.push_back({judged.claim->id, judged.claim->source, judged.claim->statement,
                     judged.claim->rule, numbers_of(judged), name_of(judged.verdict),
                     judged.outcome.note});
  page.table("Every claim. A click on a heading sorts.",
             {"claim", "source", "published", "rule", "measured", "verdict", "note"}, cells);
  for (const Judged& judged : list) {
    if (judged.outcome.figure.empty()) continue;
    const std::string name = "figures/" + judged.claim->id + ".svg";
    write_report_file(folder / name, judged.outcome.figure);
    files.push_back(name);
    page.figure(judged.outcome.figure, judged.claim->id + ": " + judged.claim->statement);
  }
  if (!rows.empty()) {
    page.heading("All runs");
    add_rows(page, rows);
  }
  write_report_file(folder / "results.csv", claims_csv(list));
  write_report_file(folder / "runs.csv", results_csv(rows));
  write_report_file(folder / "report.html", page.text());
  return files;
}

void write_page(const std::filesystem::path& file, const json& device, const std::string& command,
                const std::vector<Judged>& list) {
  std::string text = "# Published claims, measured\n\nWritten by `" + command +
                     "`. Device: " + device_text(device) + ".\n\n" + method + "\n\n" +
                     counts_of(list) +
                     "\n\n| claim | source | published | rule | measured | verdict |\n"
                     "|---|---|---|---|---|---|\n";
  for (const Judged& judged : list) {
    std::string measured = numbers_of(judged);
    if (!judged.outcome.note.empty())
      measured += (measured.empty() ? "" : ". ") + judged.outcome.note;
    text += "| " + judged.claim->id + " | " + judged.claim->source + " | " +
            cell_of(judged.claim->statement) + " | " + cell_of(judged.claim->rule) + " | " +
            cell_of(measured) + " | " + name_of(judged.verdict) + " |\n";
  }
  write_report_file(file, text);
}

}  // namespace penumbra::experiments::claims
