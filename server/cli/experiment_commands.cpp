#include <charconv>
#include <cmath>
#include <memory>

#include "experiments/claims/run.h"
#include "experiments/sweep/sweep.h"
#include "experiments/tradeoff/tradeoff.h"
#include "renderer/error.h"
#include "scenes/library.h"
#include "server/cli/experiment_options.h"
#include "server/cli/session.h"
#include "server/cli/table.h"

namespace penumbra::server::cli {
namespace {

using experiments::parts_of;

struct Options : ExperimentOptions {
  std::string scenes;
  std::string techniques;
  std::string sizes;
  std::uint32_t light_samples = 256;
  bool errors = false;
  bool bias = false;
  std::string study;

  void add_to(CLI::App& command) {
    add_common_to(command);
    command.add_option("--light-samples", light_samples, "Light points of the reference")
        ->check(CLI::Range(1u, RenderLimits::max_light_samples))
        ->capture_default_str();
  }
};

std::vector<std::uint32_t> sizes_of(const std::string& list) {
  std::vector<std::uint32_t> sizes;
  for (const std::string& part : parts_of(list)) {
    std::uint32_t size = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), size);
    if (error != std::errc() || end != part.data() + part.size())
      throw bad_value("sizes", "--sizes takes whole numbers of pixels, not '" + part + "'");
    sizes.push_back(size);
  }
  return sizes;
}

int finish(const Session& session, const Options& options, const nlohmann::json& summary) {
  std::string text = summary.at("rows").dump() + " runs, " + summary.at("measured").dump() +
                     " measured now, " + summary.at("failed").dump() + " failed\n";
  for (const auto& file : summary.at("files"))
    if (!file.get<std::string>().starts_with("figures/"))
      text += "wrote " + (options.out / file.get<std::string>()).string() + "\n";
  session.print(summary, text);
  return 0;
}

int run_sweep(const Session& session, const Options& options) {
  experiments::SweepOptions sweep;
  sweep.engine = options.engine();
  sweep.scenes = list_of("scenes", options.scenes);
  sweep.techniques = list_of("techniques", options.techniques);
  if (!options.sizes.empty() && (sweep.sizes = sizes_of(options.sizes)).empty())
    throw bad_value("sizes", "--sizes names nothing");
  sweep.errors = options.errors;
  sweep.light_samples = options.light_samples;
  sweep.command = "penumbra sweep";
  if (!options.scenes.empty()) sweep.command += " --scenes '" + options.scenes + "'";
  if (!options.techniques.empty()) sweep.command += " --techniques '" + options.techniques + "'";
  if (!options.sizes.empty()) sweep.command += " --sizes " + options.sizes;
  if (options.errors) sweep.command += " --errors";
  Progress bar("sweep");
  experiments::ProgressFile file(options.out);
  sweep.progress = shown(bar, file);
  return finish(session, options, experiments::sweep(sweep));
}

int run_tradeoff(const Session& session, const Options& options) {
  experiments::TradeoffOptions tradeoff;
  tradeoff.engine = options.engine();
  tradeoff.scene = options.scenes;
  tradeoff.techniques = list_of("techniques", options.techniques);
  tradeoff.bias = options.bias;
  tradeoff.study = options.study;
  tradeoff.light_samples = options.light_samples;
  if (!options.sizes.empty()) {
    const auto sizes = sizes_of(options.sizes);
    if (sizes.size() != 1) throw bad_value("size", "--size takes one number of pixels");
    tradeoff.size = sizes.front();
  }
  tradeoff.command = "penumbra tradeoff " + options.scenes;
  if (!options.techniques.empty()) tradeoff.command += " --techniques '" + options.techniques + "'";
  if (!options.sizes.empty()) tradeoff.command += " --size " + options.sizes;
  if (options.bias) tradeoff.command += " --bias";
  if (!options.study.empty())
    tradeoff.command +=
        " --study '" + std::filesystem::path(options.study).filename().string() + "'";
  Progress bar("tradeoff");
  experiments::ProgressFile file(options.out);
  tradeoff.progress = shown(bar, file);
  return finish(session, options, experiments::tradeoff(tradeoff));
}

struct ClaimsOptions {
  ExperimentOptions common;
  std::string only;
  bool quick = false;
  std::filesystem::path page;
};

int run_claims(const Session& session, const ClaimsOptions& given) {
  experiments::claims::Options options;
  options.engine = given.common.engine();
  options.only = list_of("only", given.only);
  options.quick = given.quick;
  options.page = given.page;
  options.command = "penumbra claims";
  if (!given.only.empty()) options.command += " --only " + given.only;
  if (given.quick) options.command += " --quick";
  if (given.common.run_ms != experiments::TimingBudget{}.run_ms)
    options.command += " --run-ms " + std::to_string(std::lround(given.common.run_ms));
  Progress bar("claims");
  experiments::ProgressFile file(given.common.out);
  options.progress = shown(bar, file);
  const nlohmann::json summary = experiments::claims::run(options);
  Table table({"claim", "verdict", "published"});
  for (const auto& claim : summary.at("claims"))
    table.add({claim.at("id"), claim.at("verdict"), claim.at("statement")});
  session.print(summary,
                table.text(true) + "wrote " + (given.common.out / "report.html").string() + "\n");
  return 0;
}

void add_claims_command(CLI::App& app, Session& session) {
  auto claims = std::make_shared<ClaimsOptions>();
  CLI::App* command = app.add_subcommand(
      "claims", "Measure what was published, claim by claim; goes on where it was stopped");
  command->add_option("--only,--ids", claims->only, "Ids of claims, separated by commas [all]");
  command->add_flag("--quick", claims->quick, "Small pictures: minutes instead of an hour");
  command->add_option("--page", claims->page, "Also write the table as Markdown to this file");
  claims->common.out = "claims";
  claims->common.add_common_to(*command);
  command->get_option("--out")->required(false)->capture_default_str();
  add_json_flag(*command, session);
  command->callback([claims, &session] {
    session.action = [claims, &session] { return run_claims(session, *claims); };
  });
}

}  // namespace

void add_experiment_commands(CLI::App& app, Session& session) {
  add_claims_command(app, session);
  auto sweep = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Time techniques over scenes and sizes; goes on where it was stopped");
  command->add_option("--scenes", sweep->scenes,
                      "Scenes or patterns (* and ?), separated by commas, such as "
                      "'sweep:*x1600x3' [the scenes of 2007; fewer on a processor]");
  command->add_option("--techniques", sweep->techniques,
                      "ID[:NAME=VALUE]..., separated by commas [all that do not trace rays; those "
                      "of table 4.1 on a processor]");
  command->add_option("--sizes", sweep->sizes,
                      "Edges of the pictures in pixels, separated by commas [25 to 1200; 100 and "
                      "300 on a processor]");
  command->add_flag("--errors", sweep->errors, "Also judge every picture against the reference");
  sweep->add_to(*command);
  add_json_flag(*command, session);
  command->callback([sweep, &session] {
    session.action = [sweep, &session] { return run_sweep(session, *sweep); };
  });

  auto tradeoff = std::make_shared<Options>();
  command = app.add_subcommand(
      "tradeoff", "Search what error each technique buys for how much time, over its parameters");
  command->add_option("SCENE", tradeoff->scenes, scenes::ways_to_name_a_scene())->required();
  command->add_option("--techniques", tradeoff->techniques,
                      "Ids, separated by commas [all that have parameters and draw this scene]");
  command->add_option("--size", tradeoff->sizes, "Edge of the picture in pixels [300]");
  command->add_flag("--bias", tradeoff->bias,
                    "Instead: error over bias, strategy and map size, against exact hard shadows");
  command->add_option("--study", tradeoff->study,
                      "results.json of a study: also what people ranked, over time; published: "
                      "the tables of 2007");
  tradeoff->add_to(*command);
  add_json_flag(*command, session);
  command->callback([tradeoff, &session] {
    session.action = [tradeoff, &session] { return run_tradeoff(session, *tradeoff); };
  });
}

}  // namespace penumbra::server::cli
