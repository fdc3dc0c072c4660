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

}  // namespace

void add_plan_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<RequestOptions>();
  CLI::App* command =
      app.add_subcommand("plan", "Say what a render would upload and draw, and why");
  options->add_to(*command);
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] {
      const json plan = plan_document(options->read(false));
      session.print(plan, plan_text(plan));
      return 0;
    };
  });
}

}  // namespace penumbra::server::cli
