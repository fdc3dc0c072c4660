#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace penumbra::server::cli {

/// What a command works with besides its options.
struct Session {
  bool json = false;            ///< one document on standard output and nothing else
  std::function<int()> action;  ///< set by the command that was named

  /// Prints a document where --json was given, otherwise what people read.
  void print(const nlohmann::json& document, const std::string& text) const;
};

/// Adds --json to a command.
void add_json_flag(CLI::App& command, Session& session);

/// Each adds one command, or a few that belong together.
void add_serve_commands(CLI::App& app, Session& session);      // serve, worker
void add_render_commands(CLI::App& app, Session& session);     // render, measure
void add_plan_command(CLI::App& app, Session& session);        // plan
void add_compare_command(CLI::App& app, Session& session);     // compare
void add_catalogue_commands(CLI::App& app, Session& session);  // scenes, techniques
void add_scene_commands(CLI::App& app, Session& session);      // import, export-scene
void add_statistics_command(CLI::App& app, Session& session);  // statistics
void add_power_command(CLI::App& app, Session& session);       // power
void add_simulate_command(CLI::App& app, Session& session);    // simulate-study
void add_doctor_command(CLI::App& app, Session& session);      // doctor
void add_demo_command(CLI::App& app, Session& session);        // demo
void add_stability_command(CLI::App& app, Session& session);   // stability
void add_data_commands(CLI::App& app, Session& session);       // backup, restore, verify, export

/// claims, sweep, tradeoff
void add_experiment_commands(CLI::App& app, Session& session);
void add_recommend_command(CLI::App& app, Session& session);  // recommend

/// Arguments with the environment (PENUMBRA_NAME) and the file of --config put in where no flag
/// says otherwise. Throws bad_value for unknown keys.
std::vector<std::string> complete_arguments(const CLI::App& app,
                                            std::vector<std::string> arguments);

}  // namespace penumbra::server::cli
