#include <algorithm>
#include <memory>
#include <sstream>

#include "experiments/recommend/recommend.h"
#include "renderer/error.h"
#include "scenes/library.h"
#include "server/cli/experiment_options.h"
#include "server/cli/session.h"
#include "server/cli/table.h"

namespace penumbra::server::cli {
namespace {

namespace recommend = experiments::recommend;
using nlohmann::json;

constexpr double mebibyte = 1 << 20;  ///< bytes

struct RecommendOptions : ExperimentOptions {
  recommend::Options asked;
  std::optional<double> memory_mib;
  bool evaluate = false;
};

std::string command_of(const RecommendOptions& given) {
  const recommend::Options& asked = given.asked;
  std::ostringstream text;
  text << "penumbra recommend";
  if (!asked.scene.empty()) text << " " << asked.scene;
  if (given.evaluate) text << " --evaluate";
  if (asked.budget_ms) text << " --budget-ms " << *asked.budget_ms;
  if (asked.memory_bytes) text << " --memory-bytes " << *asked.memory_bytes;
  text << " --objective " << asked.objective;
  if (asked.study != experiments::published_ranks)
    text << " --study '" << std::filesystem::path(asked.study).filename().string() << "'";
  for (const std::string& file : asked.from) text << " --from " << file;
  if (!given.evaluate) text << " --size " << asked.size;
  return text.str();
}

std::string percent_of(const json& estimate) {
  const json& interval = estimate.at("ci95");
  const auto percent = [](const json& share) { return number(100.0 * share.get<double>(), 1); };
  return percent(estimate.at("mean")) + "% (" + percent(interval.at(0)) + " to " +
         percent(interval.at(1)) + ")";
}

std::string text_of(const json& summary, const std::string& out) {
  const json& pick = summary.at("recommendation");
  std::string text = pick.at("name").get<std::string>() + ": " + number(pick.at("frame_ms"), 2) +
                     " ms, " + number(pick.at("over_none"), 2) + " times no shadows, " +
                     number(pick.at("memory_bytes").get<double>() / mebibyte, 2) + " MiB, error " +
                     number(pick.at("error"), 4) +
                     (pick.at("fits") ? "\n" : ": nothing that was tried keeps the budget\n");
  for (const json& note : pick.at("notes")) text += "note: " + note.get<std::string>() + "\n";
  Table tried({"tried", "ms", "MiB", "error", "fits"});
  for (const json& row : summary.at("tried"))
    tried.add({row.at("name"), number(row.at("frame_ms"), 2),
               number(row.at("memory_bytes").get<double>() / mebibyte, 2),
               number(row.at("error"), 4), row.at("fits") ? "yes" : "no"});
  Table savings({"not needed", "saves ms", "saves MiB", "error before", "then", "worth it"});
  for (const json& row : summary.at("savings"))
    savings.add({row.at("what"), number(row.at("saved_ms"), 2),
                 number(row.at("saved_bytes").get<double>() / mebibyte, 2),
                 number(row.at("error_before"), 4), number(row.at("error"), 4),
                 row.at("taken")      ? "done"
                 : row.at("worth_it") ? "yes"
                                      : "no"});
  text += "\n" + tried.text() + "\n" + savings.text();
  for (const json& row : summary.at("refused"))
    text += "refused: " + row.at("name").get<std::string>() + ": " +
            row.at("reason").get<std::string>() + "\n";
  return text + "wrote " + out + "/report.html\n";
}

int run(const Session& session, RecommendOptions given) {
  if (given.memory_mib) given.asked.memory_bytes = *given.memory_mib * mebibyte;
  given.asked.engine = given.engine();
  given.asked.command = command_of(given);
  if (given.evaluate) {
    const auto devices = list_devices();
    const bool gpu = std::any_of(devices.begin(), devices.end(),
                                 [](const DeviceInfo& device) { return device.type != "cpu"; });
    const json summary = recommend::evaluate_model(given.asked, gpu);
    session.print(summary, "regret in time at equal error " +
                               percent_of(summary.at("time_regret")) +
                               "\nerror above the least that fits, of that without shadows " +
                               percent_of(summary.at("error_regret")) + "\nwrote " +
                               (given.out / "report.html").string() + "\n");
    return 0;
  }
  if (given.asked.scene.empty()) throw bad_value("scene", "SCENE is missing");
  Progress bar("recommend");
  experiments::ProgressFile file(given.out);
  given.asked.progress = shown(bar, file);
  const json summary = recommend::recommend(given.asked);
  session.print(summary, text_of(summary, given.out.string()));
  return 0;
}

}  // namespace

void add_recommend_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<RecommendOptions>();
  CLI::App* command = app.add_subcommand(
      "recommend", "Which technique, layout and parameters for a scene and a budget");
  command->add_option("SCENE", options->asked.scene, scenes::ways_to_name_a_scene());
  command->add_option("--budget-ms,--time-ms", options->asked.budget_ms,
                      "Milliseconds that a frame may take [50: 20 frames a second]");
  CLI::Option* bytes = command->add_option("--memory-bytes", options->asked.memory_bytes,
                                           "Bytes that a technique may take over none [any]");
  command->add_option("--memory-mib", options->memory_mib, "The same in MiB")->excludes(bytes);
  std::string names;
  for (const auto& objective : recommend::objectives())
    names += (names.empty() ? "" : ", ") + std::string(objective.name);
  command->add_option("--objective", options->asked.objective, "What is to be small: " + names)
      ->capture_default_str();
  command->add_option("--from", options->asked.from,
                      "results.csv of sweep --errors or tradeoff, also to learn from");
  command
      ->add_option("--study", options->asked.study,
                   "results.json of a study, for perceived: ranks of the scene where it showed it; "
                   "published: tables 4.3 to 4.9 of 2007")
      ->capture_default_str();
  command->add_option("--size", options->asked.size, "Edge of the picture in pixels")
      ->capture_default_str();
  command
      ->add_option("--light-samples", options->asked.light_samples, "Light points of the reference")
      ->check(CLI::Range(1u, RenderLimits::max_light_samples))
      ->capture_default_str();
  command->add_flag(
      "--evaluate", options->evaluate,
      "Instead: judge recommendations on scenes that were left out, from results alone");
  options->out = "recommend";
  options->run_ms = 200.0;
  options->add_common_to(*command);
  command->get_option("--out")->required(false)->capture_default_str();
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] { return run(session, *options); };
  });
}

}  // namespace penumbra::server::cli
