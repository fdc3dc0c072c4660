#include <sstream>

#include "scenes/library.h"
#include "server/cli/session.h"
#include "server/cli/table.h"
#include "server/jobs/catalogue.h"
#include "techniques/layout_matrix.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;

std::string text_of(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

int list_scenes(const Session& session, const std::filesystem::path& data) {
  const json document = scene_catalogue(data);
  Table table{{"scene", "title", "what it shows"}};
  for (const json& scene : document.at("scenes"))
    table.add(
        {text_of(scene.at("id")), text_of(scene.at("title")), text_of(scene.at("description"))});
  session.print(document, table.text(true) + scenes::generated_forms_explained() + "\n");
  return 0;
}

/// "integer 1..16384, log", "off|on".
std::string range_of(const json& schema) {
  if (schema.contains("enum")) {
    std::string list;
    for (const json& choice : schema["enum"]) list += (list.empty() ? "" : "|") + text_of(choice);
    return list;
  }
  if (!schema.contains("minimum")) return text_of(schema.at("type"));
  std::string text = text_of(schema["minimum"]) + ".." + text_of(schema.at("maximum"));
  if (schema.value("x-unit", "") != "") text += " " + schema["x-unit"].get<std::string>();
  return text;
}

std::string technique_text(const json& technique, const json& presets) {
  std::ostringstream text;
  text << technique.at("id").get<std::string>() << " (" << text_of(technique.at("label"))
       << "): " << text_of(technique.at("title")) << "\n  family "
       << text_of(technique.at("family")) << "; " << text_of(technique.at("source")) << "\n";
  Table parameters{{"  parameter", "default", "range", "meaning"}};
  for (const auto& [name, schema] : technique.at("parameters").at("properties").items())
    parameters.add({"  " + name, text_of(schema.at("default")), range_of(schema),
                    schema.value("description", "")});
  text << parameters.text(true);
  for (const json& diagnostic : technique.at("diagnostics"))
    text << "  diagnostic " << text_of(diagnostic.at("name")) << ": "
         << text_of(diagnostic.at("meaning")) << "\n";
  for (const json& preset : presets)
    if (preset.at("technique") == technique.at("id"))
      text << "  preset " << text_of(preset.at("id")) << " (" << text_of(preset.at("label"))
           << "): " << text_of(preset.at("title")) << " " << preset.at("parameters").dump() << "\n";
  return text.str();
}

int list_techniques(const Session& session) {
  const json document = technique_catalogue();
  std::string text;
  for (const json& technique : document.at("techniques"))
    text += (text.empty() ? "" : "\n") + technique_text(technique, document.at("presets"));
  session.print(document, text);
  return 0;
}

/// Which lights each technique draws with each layout of its map.
int list_layouts(const Session& session) {
  const auto rows = techniques::layout_matrix();
  json document = json::array();
  std::vector<std::string> head{"technique"};
  for (const auto& [layout, lights] : rows.front().lights) head.push_back(layout);
  Table table{head};
  for (const techniques::LayoutRow& row : rows) {
    document.push_back({{"technique", row.technique}, {"layouts", row.lights}});
    std::vector<std::string> cells{row.technique};
    for (const auto& [layout, lights] : row.lights) {
      std::string names;
      for (const std::string& light : lights) names += (names.empty() ? "" : ", ") + light;
      cells.push_back(names.empty() ? "-" : names);
    }
    table.add(cells);
  }
  session.print({{"matrix", document}}, table.text(true));
  return 0;
}

}  // namespace

void add_catalogue_commands(CLI::App& app, Session& session) {
  auto data = std::make_shared<std::filesystem::path>();
  CLI::App* scenes = app.add_subcommand("scenes", "List scenes");
  scenes->add_option("--data", *data, "Folder of imported scenes");
  add_json_flag(*scenes, session);
  scenes->callback([data, &session] {
    session.action = [data, &session] { return list_scenes(session, *data); };
  });

  CLI::App* techniques =
      app.add_subcommand("techniques", "List techniques, parameters and presets");
  auto matrix = std::make_shared<bool>(false);
  techniques->add_flag("--matrix", *matrix, "Lights that each technique draws with each layout");
  add_json_flag(*techniques, session);
  techniques->callback([matrix, &session] {
    session.action = [matrix, &session] {
      return *matrix ? list_layouts(session) : list_techniques(session);
    };
  });
}

}  // namespace penumbra::server::cli
