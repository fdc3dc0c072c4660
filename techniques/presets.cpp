#include "techniques/presets.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "renderer/error.h"
#include "renderer/frame/common_parameters.h"
#include "techniques/parameter_schema.h"

namespace penumbra::techniques {
namespace {

void finish_parameter(const std::string& technique, Parameter& parameter) {
  const std::string where = "technique " + technique + ", parameter " + parameter.name + ": ";
  const bool number =
      parameter.type == ParameterType::integer || parameter.type == ParameterType::real;
  if (parameter.name.empty()) throw std::logic_error(where + "has no name");
  if (parameter.meaning.empty()) throw std::logic_error(where + "has no meaning");
  if (number && !(parameter.minimum <= parameter.maximum))
    throw std::logic_error(where + "minimum is above maximum");
  if (number && parameter.scale == ParameterScale::logarithmic && !(parameter.minimum > 0.0))
    throw std::logic_error(where + "a logarithmic range must begin above 0");

  // Schemas print the default as it is, so 1 becomes 1.0 where a real is declared.
  try {
    parameter.default_value = checked_value(parameter, parameter.default_value);
  } catch (const Error& error) {
    throw std::logic_error(where + "default: " + error.what());
  }
}

/// A condition names a choice that there is.
void check_conditions(const TechniqueDescription& description) {
  for (const Parameter& parameter : description.parameters) {
    if (!parameter.only_with) continue;
    const Choices& needed = *parameter.only_with;
    for (const std::string& value : needed.values)
      if (std::none_of(description.parameters.begin(), description.parameters.end(),
                       [&](const Parameter& other) {
                         return other.name == needed.name &&
                                std::find(other.choices.begin(), other.choices.end(), value) !=
                                    other.choices.end();
                       }))
        throw std::logic_error("technique " + description.id + ", parameter " + parameter.name +
                               ": there is no choice " + value + " of " + needed.name);
  }
}

void finish_description(TechniqueDescription& description) {
  if (description.shader.empty())
    description.shader = "techniques/" + description.id + "/shadow.glsl";
  if (!description.create)
    throw std::logic_error("technique " + description.id + " cannot be created");
  const auto& common = common_parameters();
  description.parameters.insert(description.parameters.end(), common.begin(), common.end());
  check_conditions(description);
  std::set<std::string> names;
  for (Parameter& parameter : description.parameters) {
    finish_parameter(description.id, parameter);
    if (!names.insert(parameter.name).second)
      throw std::logic_error("technique " + description.id + " declares parameter " +
                             parameter.name + " twice");
  }
}

std::string text_of(const nlohmann::json& preset, const std::string& key,
                    const std::string& where) {
  const auto found = preset.find(key);
  if (found == preset.end() || !found->is_string() || found->get<std::string>().empty())
    throw unreadable(where + ": \"" + key + "\" must be a text", key);
  return found->get<std::string>();
}

Preset preset_from_json(const TechniqueDescription& technique, const nlohmann::json& json,
                        const std::string& file) {
  if (!json.is_object()) throw unreadable(file + ": every preset must be an object");
  Preset preset;
  preset.id = text_of(json, "id", file);
  const std::string where = file + ": preset " + preset.id;
  preset.technique = technique.id;
  preset.label = text_of(json, "label", where);
  preset.title = text_of(json, "title", where);
  preset.source = text_of(json, "source", where);

  static const std::set<std::string> keys{"id", "label", "title", "source", "parameters"};
  for (const auto& [key, value] : json.items())
    if (!keys.contains(key)) throw unreadable(where + ": unknown key \"" + key + "\"", key);
  if (!json.contains("parameters"))
    throw unreadable(where + ": \"parameters\" is missing", "parameters");

  // Keep only what the preset says, in the declared types; defaults join when it is used.
  try {
    const ParameterValues given = values_from_json(json["parameters"]);
    const ParameterValues complete = complete_parameters(technique.parameters, given);
    for (const auto& [name, value] : given) preset.parameters[name] = complete.at(name);
  } catch (const Error& error) {
    throw unreadable(where + ": " + error.what(), error.field);
  }
  return preset;
}

}  // namespace

std::vector<TechniqueDescription> finish_descriptions(std::vector<TechniqueDescription> list) {
  std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i > 0 && list[i].id == list[i - 1].id)
      throw std::logic_error("two techniques have the id " + list[i].id);
    finish_description(list[i]);
  }
  return list;
}

std::vector<Preset> read_presets(const std::vector<TechniqueDescription>& list,
                                 std::span<const EmbeddedFile> files) {
  std::map<std::string, std::string> owner_of_id;
  for (const TechniqueDescription& technique : list)
    owner_of_id[technique.id] = "technique " + technique.id;

  std::vector<Preset> presets;
  for (const TechniqueDescription& technique : list) {
    const std::string path = "techniques/" + technique.id + "/presets.json";
    const auto file = std::find_if(files.begin(), files.end(),
                                   [&](const EmbeddedFile& f) { return f.path == path; });
    if (file == files.end()) continue;

    nlohmann::json array;
    try {
      array = nlohmann::json::parse(file->text);
    } catch (const nlohmann::json::parse_error& error) {
      throw unreadable(path + ": " + error.what());
    }
    if (!array.is_array()) throw unreadable(path + ": must be an array of presets");
    for (const nlohmann::json& json : array) {
      Preset preset = preset_from_json(technique, json, path);
      const auto [owner, is_new] = owner_of_id.emplace(preset.id, path);
      if (!is_new)
        throw unreadable(path + ": id " + preset.id + " is taken already by " + owner->second,
                         "id");
      presets.push_back(std::move(preset));
    }
  }
  return presets;
}

}  // namespace penumbra::techniques
