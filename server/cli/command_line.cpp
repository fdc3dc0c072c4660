#include "server/cli/command_line.h"

#include <csignal>
#include <iostream>

#include "renderer/error.h"
#include "scenes/json_text.h"
#include "server/cli/session.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;

int report(const Session& session, const Error& error) {
  std::cerr << "penumbra: " << error.what() << '\n';
  if (session.json)
    std::cout << scenes::json_text(
                     {{"error",
                       {{"code", error.code}, {"message", error.what()}, {"field", error.field}}}},
                     2)
              << '\n';
  return error.code == "bad_value" || error.code == "not_found" ? wrong_usage : failed;
}

/// True where --json is among the arguments: errors of reading them keep to it as well.
bool asks_for_json(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments)
    if (argument == "--json") return true;
  return false;
}

}  // namespace

void Session::print(const nlohmann::json& document, const std::string& text) const {
  if (json) {
    std::cout << scenes::json_text(document, 2) << '\n';
  } else {
    std::cout << text;
  }
  std::cout.flush();
}

void add_json_flag(CLI::App& command, Session& session) {
  command.add_flag("--json", session.json, "Print one JSON document on standard output");
}

int run(int argc, const char* const* argv) {
  std::signal(SIGPIPE, SIG_IGN);
  Session session;
  CLI::App app{"Penumbra: a laboratory for shadow techniques", "penumbra"};
  app.set_version_flag("--version", std::string(PENUMBRA_VERSION));
  app.require_subcommand(1);
  std::string config;
  app.add_option("--config", config,
                 "File of options, TOML or INI: name = value, in a section [command] or for all");
  add_serve_commands(app, session);
  add_render_commands(app, session);
  add_plan_command(app, session);
  add_compare_command(app, session);
  add_catalogue_commands(app, session);
  add_scene_commands(app, session);
  add_statistics_command(app, session);
  add_power_command(app, session);
  add_simulate_command(app, session);
  add_doctor_command(app, session);
  add_demo_command(app, session);
  add_stability_command(app, session);
  add_experiment_commands(app, session);
  add_recommend_command(app, session);
  add_data_commands(app, session);

  std::vector<std::string> arguments(argv + 1, argv + argc);
  session.json = asks_for_json(arguments);
  try {
    arguments = complete_arguments(app, std::move(arguments));
    std::vector<std::string> backwards(arguments.rbegin(), arguments.rend());  // as CLI11 wants it
    app.parse(backwards);
    return session.action();
  } catch (const CLI::Success& success) {
    app.exit(success);  // help or version
    return done;
  } catch (const CLI::ParseError& error) {
    return report(session, bad_value("", error.what()));
  } catch (const Error& error) {
    return report(session, error);
  } catch (const std::exception& error) {
    return report(session, Error("internal", error.what()));
  }
}

}  // namespace penumbra::server::cli
