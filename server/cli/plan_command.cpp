#include "experiments/plan/shares.h"
#include "server/cli/request_options.h"
#include "server/cli/session.h"
#include "server/cli/table.h"
#include "server/jobs/plan_document.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;

std::string mebibytes(const json& bytes) {
  return number(bytes.get<double>() / (1 << 20), 2);
}

std::string plan_text(const json& plan) {
  if (!plan.at("supported"))
    return plan.at("technique").get<std::string>() +
           " cannot draw this: " + plan.at("reason").get<std::string>() + "\n";
  Table table({"rule", "subject", "plan", "why", "MiB"});
  for (const json& line : plan.at("lines"))
    table.add({line.at("rule"), line.at("subject"), line.at("kept") ? "kept" : "dropped",
               line.at("reason"), line.at("bytes") == 0 ? "" : mebibytes(line.at("bytes"))});
  const json& bytes = plan.at("bytes");
  return table.text(true) + "\nof the scene, " + mebibytes(bytes.at("kept")) +
         " MiB go to the device and " + mebibytes(bytes.at("dropped")) +
         " MiB do not; the technique adds at least " + mebibytes(bytes.at("technique")) + " MiB\n";
}

/// What each rule saves of a frame, and what the technique takes of it.
json measured(const RequestOptions& options, const CanonicalRequest& request) {
  Renderer renderer(RendererOptions{options.device, options.validation});
  const auto shares =
      experiments::plan::measure_shares(renderer, to_render_request(request), {.run_ms = 300.0});
  json rules = json::array();
  for (const auto& share : shares.rules)
    rules.push_back({{"rule", share.rule},
                     {"without_ms", share.without_ms},
                     {"saves_ms", share.without_ms - shares.frame_ms}});
  return {{"device", renderer.device().name}, {"frame_ms", shares.frame_ms},
          {"none_ms", shares.none_ms},        {"technique_ms", shares.frame_ms - shares.none_ms},
          {"settled", shares.settled},        {"rules", rules}};
}

std::string measured_text(const json& measured) {
  const auto ms = [&](const json& part, const char* key) {
    return number(part.at(key).get<double>(), 3);
  };
  Table table({"rule", "frame without it, ms", "saves, ms"});
  for (const json& rule : measured.at("rules"))
    table.add({rule.at("rule"), ms(rule, "without_ms"), ms(rule, "saves_ms")});
  return "\na frame takes " + ms(measured, "frame_ms") + " ms on " +
         measured.at("device").get<std::string>() + ", of which " + ms(measured, "technique_ms") +
         " ms are the technique's" + (measured.at("settled") ? "" : " (NOT SETTLED)") + "\n" +
         table.text(true);
}

}  // namespace

void add_plan_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<RequestOptions>();
  auto measure = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("plan", "Say what a render would upload and draw, and why");
  options->add_to(*command);
  command->add_flag("--measure", *measure,
                    "Draw with each rule left out in turn and tell what it saves of a frame");
  add_json_flag(*command, session);
  command->callback([options, measure, &session] {
    session.action = [options, measure, &session] {
      const auto request = options->read(false);
      json plan = plan_document(request);
      std::string text = plan_text(plan);
      if (*measure && plan.at("supported")) {
        plan["measured"] = measured(*options, request);
        text += measured_text(plan["measured"]);
      }
      session.print(plan, text);
      return 0;
    };
  });
}

}  // namespace penumbra::server::cli
