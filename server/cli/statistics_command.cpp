#include <filesystem>

#include "renderer/error.h"
#include "scenes/json_text.h"
#include "server/cli/session.h"
#include "server/cli/written_file.h"
#include "server/jobs/durable_file.h"
#include "study/figures.h"
#include "study/report/html.h"
#include "study/report/latex.h"
#include "study/responses.h"
#include "study/statistics/report.h"

namespace penumbra::server::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path responses;
  fs::path measures;
  fs::path out;
};

std::string text_of(const fs::path& path, const char* field) {
  auto text = read_whole(path);
  if (!text) throw unreadable("cannot read " + path.string(), field);
  return std::move(*text);
}

int analyse(const Session& session, const Options& paths) {
  const auto text = text_of(paths.responses, "RESPONSES");
  study::FigureOptions figures;
  if (!paths.measures.empty())
    figures.measures = study::parse_measures(text_of(paths.measures, "--measures"));
  const study::ReportOptions options;
  const nlohmann::json report = study::statistics_report(study::parse_responses(text), options);
  const std::string table = study::statistics_table(report, options);
  if (!paths.out.empty()) {
    fs::create_directories(paths.out / "figures");
    write_file(paths.out / "results.json", scenes::json_text(report, 2) + "\n");
    write_file(paths.out / "results.tex", study::latex_tables(report, options.labels));
    write_file(paths.out / "report.html", study::html_report(report, {nullptr, {}, figures}));
    write_file(paths.out / "tables.txt", table);
    for (const auto& figure : study::figures_of(report, figures))
      write_file(paths.out / "figures" / (figure.name + ".svg"), figure.svg);
  }
  session.print(report, table);
  return 0;
}

}  // namespace

void add_statistics_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("statistics", "Analyse the answers to a ranking survey");
  command->add_option("RESPONSES", options->responses, "CSV with a row per picture ranked")
      ->required()
      ->check(CLI::ExistingFile);
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
