#include <filesystem>
#include <memory>

#include "renderer/error.h"
#include "server/cli/progress.h"
#include "server/cli/session.h"
#include "server/cli/study_client.h"
#include "server/cli/written_file.h"
#include "server/files/durable_file.h"
#include "study/simulate.h"

namespace penumbra::server::cli {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  fs::path study;
  fs::path out;
  std::string url;
  fs::path token_file;
  std::size_t participants = 0;
  std::size_t inverted = 0;
  std::size_t random = 0;
  std::uint64_t seed = 1;
  double step = 0.5;
};

std::string token_of(const SimulateOptions& options) {
  if (options.token_file.empty()) return {};
  auto token = read_whole(options.token_file);
  if (!token) throw unreadable("cannot read " + options.token_file.string(), "--token-file");
  token->erase(token->find_last_not_of(" \r\n") + 1);
  return *token;
}

/// Fills the study on a running server, one person after another.
void fill_server(const SimulateOptions& options, const study::Study& study,
                 const std::vector<study::SimulatedPerson>& people,
                 const study::Preferences& preferences) {
  StudyClient client(options.url, token_of(options));
  const auto body = client.open(study);
  Progress progress("people");
  for (std::size_t i = 0; i < people.size(); ++i) {
    client.take_part(study, body, people[i], preferences);
    progress.show(static_cast<double>(i + 1) / static_cast<double>(people.size()));
  }
}

int simulate(const Session& session, const SimulateOptions& options) {
  if (options.out.empty() && options.url.empty())
    throw bad_value("--url", "give a server's address, or a file with --out");
  const auto text = read_whole(options.study);
  if (!text) throw unreadable("cannot read " + options.study.string(), "STUDY");
  const study::Study study = study::parse_study(*text);
  const auto people =
      study::simulate_people(options.participants, options.inverted, options.random, options.seed);
  const auto preferences = study::default_preferences(study, options.step);
  nlohmann::json document = {{"participants", options.participants}};
  std::string said = std::to_string(options.participants) + " people";
  if (!options.url.empty()) {
    fill_server(options, study, people, preferences);
    document["study"] = study.id;
    said += " took part in " + study.id;
  }
  if (!options.out.empty()) {
    const auto rows = study::simulate_responses(study, people, preferences, options.seed);
    write_file(options.out, study::write_responses(rows));
    document["rows"] = rows.size();
    said += ", " + std::to_string(rows.size()) + " rows in " + options.out.string();
  }
  session.print(document, said + "\n");
  return 0;
}

}  // namespace

void add_simulate_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command =
      app.add_subcommand("simulate-study", "Answers of people with known preferences to a study");
  command->add_option("STUDY", options->study, "Study file (JSON)")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--participants", options->participants, "How many people")
      ->required()
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--inverted", options->inverted, "How many read the scale backwards");
  command->add_option("--random", options->random, "How many have no preference");
  command->add_option("--seed", options->seed, "Of all random numbers");
  command
      ->add_option("--step", options->step,
                   "Difference of log worths of neighbours in the study's order of pictures")
      ->check(CLI::Range(0.0, 100.0));
  command->add_option("--out", options->out, "CSV with a row per picture ranked, without a server");
  command->add_option("--url", options->url,
                      "A running server that they take part on, as it printed it for researchers");
  command->add_option("--token-file", options->token_file,
                      "The researcher's token, where --url has none");
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] { return simulate(session, *options); };
  });
}

}  // namespace penumbra::server::cli
