#include <filesystem>
#include <iomanip>
#include <memory>
#include <sstream>

#include "renderer/error.h"
#include "server/cli/progress.h"
#include "server/cli/session.h"
#include "server/files/durable_file.h"
#include "study/statistics/power.h"

namespace penumbra::server::cli {
namespace {

namespace fs = std::filesystem;

struct PowerOptions {
  fs::path pilot;
  study::PowerPlan plan;
};

nlohmann::json document_of(const study::Population& population, const study::PowerPlan& plan,
                           const study::PowerResult& result) {
  nlohmann::json worths = nlohmann::json::object();
  for (std::size_t i = 0; i < population.techniques.size(); ++i) {
    worths[population.techniques[i]] = population.log_worths[i];
  }
  nlohmann::json curve = nlohmann::json::array();
  for (const auto& [n, power] : result.curve) {
    curve.push_back({{"participants", n}, {"power", power}});
  }
  nlohmann::json document = {
      {"participants", result.participants ? nlohmann::json(*result.participants) : nullptr},
      {"power", result.power},
      {"pair", {result.a, result.b}},
      {"difference", std::abs(result.difference)},
      {"deviation", result.deviation},
      {"curve", curve},
      {"plan",
       {{"difference", plan.difference},
        {"alpha", plan.alpha},
        {"power", plan.power},
        {"seed", plan.seed}}},
      {"pilot",
       {{"log_worths", worths},
        {"tie_of_two", population.tie_of_two},
        {"tie_of_three", population.tie_of_three},
        {"spread", population.spread},
        {"pages", population.pages}}},
      {"method",
       "paired t of participants' mean ranks, Bonferroni over all pairs; people simulated with the "
       "pilot's worths, ties of two and three, and participant variance; the two middle techniques "
       "moved apart until their mean ranks differ by the difference asked for"}};
  if (!result.reason.empty()) document["reason"] = result.reason;
  return document;
}

std::string power_text(const study::PowerPlan& plan, const study::PowerResult& result) {
  std::ostringstream text;
  text << std::setprecision(3);
  if (result.participants) {
    text << *result.participants << " participants see a difference of " << plan.difference
         << " ranks with a probability of " << result.power << "\n";
  } else {
    text << "not found: " << result.reason << "\n";
  }
  text << "(paired t, Bonferroni over all pairs at " << plan.alpha
       << "; a participant's difference varies by " << result.deviation << " ranks)\n";
  return text.str();
}

int look_up(const Session& session, const PowerOptions& options) {
  const auto text = read_whole(options.pilot);
  if (!text) throw unreadable("cannot read " + options.pilot.string(), "PILOT");
  study::statistics::Gatherer gatherer;
  study::each_response(*text, [&](const study::ResponseRow& row) { gatherer.add(row); });
  Progress progress("power");
  const auto show = [&](double value, const std::string& what) { progress.show(value, what); };
  show(0.0, "fitting the pilot");
  const auto population = study::population_of(gatherer.finish(), options.plan.seed);
  const auto result = study::participants_needed(population, options.plan, show);
  session.print(document_of(population, options.plan, result), power_text(options.plan, result));
  return 0;
}

}  // namespace

void add_power_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<PowerOptions>();
  CLI::App* command =
      app.add_subcommand("power", "How many participants a study needs, from a pilot's answers");
  command->add_option("PILOT", options->pilot, "CSV of answers, as `statistics` reads it")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--difference", options->plan.difference, "Of mean ranks, in ranks")
      ->required()
      ->check(CLI::Range(0.01, 100.0));
  command->add_option("--alpha", options->plan.alpha, "Of the family of all pairs")
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 0.5));
  command->add_option("--power", options->plan.power, "Probability to see the difference")
      ->capture_default_str()
      ->check(CLI::Range(0.05, 0.999));
  command->add_option("--seed", options->plan.seed, "Of the simulation")->capture_default_str();
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] { return look_up(session, *options); };
  });
}

}  // namespace penumbra::server::cli
