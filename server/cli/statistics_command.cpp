#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "renderer/error.h"
#include "scenes/json_text.h"
#include "server/cli/session.h"
#include "server/cli/written_file.h"
#include "server/files/durable_file.h"
#include "study/csv.h"
#include "study/report/figures.h"
#include "study/report/html.h"
#include "study/report/latex.h"
#include "study/responses.h"
#include "study/statistics/report.h"

namespace penumbra::server::cli {
namespace {

namespace fs = std::filesystem;

struct StatisticsOptions {
  fs::path responses;
  fs::path measures;
  fs::path out;
  std::string separator;
};

std::string file_text(const fs::path& path, const char* field) {
  auto text = read_whole(path);
  if (!text) throw unreadable("cannot read " + path.string(), field);
  return std::move(*text);
}

const std::map<std::string, char> separators{
    {"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {",", ','}, {";", ';'}};

int analyse(const Session& session, const StatisticsOptions& given) {
  const std::string text = file_text(given.responses, "RESPONSES");
  study::ReportOptions options;
  if (!given.measures.empty()) {
    options.measures = study::parse_measures(file_text(given.measures, "--measures"));
  }
  std::optional<char> separator;
  if (!given.separator.empty()) separator = separators.at(given.separator);
  study::statistics::Gatherer gatherer;
  const auto format = study::each_response(
      text, [&](const study::ResponseRow& row) { gatherer.add(row); }, separator);
  nlohmann::json report = study::survey_report(gatherer.finish(), options);
  if (format.separator != ',') {
    report["notes"].push_back("cells were read as separated by " +
                              study::separator_name(format.separator) +
                              ", numbers with decimal commas or points");
  }
  std::string table = study::statistics_table(report, options);
  for (const auto& note : report["notes"]) table += "\nnote: " + note.get<std::string>();
  for (const auto& warning : report["warnings"]) {
    if (warning["set"] != "all") continue;
    table += "\nwarning: " + warning["part"].get<std::string>() + ": " +
             warning["warning"].get<std::string>();
  }
  if (!table.ends_with("\n")) table += "\n";
  if (!given.out.empty()) {
    study::FigureOptions figures;
    figures.measures = options.measures;
    fs::create_directories(given.out / "figures");
    write_file(given.out / "results.json", scenes::json_text(report, 2) + "\n");
    write_file(given.out / "results.tex", study::latex_tables(report, options.labels));
    write_file(given.out / "report.html", study::html_report(report, {nullptr, {}, figures}));
    write_file(given.out / "tables.txt", table);
    for (const auto& figure : study::figures_of(report, figures))
      write_file(given.out / "figures" / (figure.name + ".svg"), figure.svg);
  }
  session.print(report, table);
  return 0;
}

}  // namespace

void add_statistics_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<StatisticsOptions>();
  CLI::App* command = app.add_subcommand("statistics", "Analyse the answers to a ranking survey");
  command->add_option("RESPONSES", options->responses, "CSV with a row per picture ranked")
      ->required()
      ->check(CLI::ExistingFile);
  command
      ->add_option("--separator", options->separator,
                   "What separates the cells; found from the header unless given")
      ->check(CLI::IsMember(separators));
  command
      ->add_option("--measures", options->measures,
                   "CSV with what was measured of the pictures (scene, technique, frame_ms_median, "
                   "rms_y, flip, ...), as a sweep writes it")
      ->check(CLI::ExistingFile);
  command->add_option("--out", options->out,
                      "Folder for results.json, results.tex, report.html, tables.txt and figures");
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] { return analyse(session, *options); };
  });
}

}  // namespace penumbra::server::cli
