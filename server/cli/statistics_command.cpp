#include <filesystem>
#include <fstream>

#include "renderer/error.h"
#include "server/cli/session.h"
#include "server/jobs/durable_file.h"
#include "study/responses.h"
#include "study/statistics/report.h"

namespace penumbra::server::cli {
namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Error("unwritable", "cannot write " + path.string());
}

int analyse(const Session& session, const fs::path& responses, const fs::path& out) {
  const auto text = read_whole(responses);
  if (!text) throw unreadable("cannot read " + responses.string(), "RESPONSES");
  const study::ReportOptions options;
  const nlohmann::json report = study::statistics_report(study::parse_responses(*text), options);
  const std::string table = study::statistics_table(report, options);
  if (!out.empty()) {
    fs::create_directories(out);
    write_text(out / "results.json", report.dump(2) + "\n");
    write_text(out / "tables.txt", table);
  }
  session.print(report, table);
  return 0;
}

}  // namespace

void add_statistics_command(CLI::App& app, Session& session) {
  struct Options {
    fs::path responses;
    fs::path out;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("statistics", "Analyse the answers to a ranking survey");
  command->add_option("RESPONSES", options->responses, "CSV with a row per picture ranked")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--out", options->out, "Folder for results.json and tables.txt");
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] {
      return analyse(session, options->responses, options->out);
    };
  });
}

}  // namespace penumbra::server::cli
