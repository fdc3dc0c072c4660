#include <filesystem>
#include <memory>

#include "renderer/error.h"
#include "server/cli/session.h"
#include "server/cli/written_file.h"
#include "server/jobs/durable_file.h"
#include "study/simulate.h"

namespace penumbra::server::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path study;
  fs::path out;
  std::size_t participants = 0;
  std::size_t inverted = 0;
  std::size_t random = 0;
  std::uint64_t seed = 1;
  double step = 0.5;
};

int simulate(const Session& session, const Options& options) {
  const auto text = read_whole(options.study);
  if (!text) throw unreadable("cannot read " + options.study.string(), "STUDY");
  const study::Study study = study::parse_study(*text);
  const auto people =
      study::simulate_people(options.participants, options.inverted, options.random, options.seed);
  const auto rows = study::simulate_responses(
      study, people, study::default_preferences(study, options.step), options.seed);
  write_file(options.out, study::write_responses(rows));
  session.print({{"participants", options.participants}, {"rows", rows.size()}},
                std::to_string(options.participants) + " people, " + std::to_string(rows.size()) +
                    " rows in " + options.out.string() + "\n");
  return 0;
}

}  // namespace

void add_simulate_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<Options>();
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
  command->add_option("--out", options->out, "CSV with a row per picture ranked")->required();
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] { return simulate(session, *options); };
  });
}

}  // namespace penumbra::server::cli
