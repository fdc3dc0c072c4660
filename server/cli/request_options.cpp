#include "server/cli/request_options.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "renderer/error.h"
#include "requests/reader.h"
#include "scenes/document.h"

namespace penumbra::server::cli {
namespace {

using requests::FieldKind;
using requests::RequestField;

std::pair<std::string, std::string> split(const std::string& flag, const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0)
    throw bad_value(flag, "--" + flag + " takes name=value, not \"" + text + "\"");
  return {text.substr(0, sign), text.substr(sign + 1)};
}

nlohmann::json list_in(const std::string& field, const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!(text << stream.rdbuf()))
    throw bad_value(
        field, "--" + requests::flag_of(*requests::find_field(field)) + ": cannot read " + file);
  try {
    return scenes::parse_json(text.str(), file);
  } catch (const Error& error) {
    throw bad_value(field, error.what());
  }
}

/// Adds one of the values of a field that holds several.
void add_entry(nlohmann::json& request, const RequestField& field, const std::string& entry) {
  const std::string flag = requests::flag_of(field);
  const auto [name, value] = split(flag, entry);
  if (field.kind == FieldKind::changes) return requests::add_change(request, field, name, value);
  if (request[field.name].contains(name))
    throw bad_value(name, "--" + flag + " " + name + " is given twice");
  request[field.name][name] = value;
}

bool holds_several(const RequestField& field) {
  return field.kind == FieldKind::parameters || field.kind == FieldKind::changes;
}

/// What an option's value looks like, where it is no plain one.
std::string form_of(const RequestField& field) {
  switch (field.kind) {
    case FieldKind::parameters:
      return ", name=value; may be repeated";
    case FieldKind::changes:
      return ", NAME.key=value, as in " + requests::change_example(field) + "; may be repeated";
    case FieldKind::list:
      return ", from a JSON file";
    default:
      return "";
  }
}

std::string help_of(const RequestField& field) {
  std::string text = field.meaning + form_of(field);
  for (const auto choice : field.allowed)
    text += (choice == field.allowed.front() ? ": " : ", ") + std::to_string(choice);
  if (!field.default_value.is_null()) return text + " [" + field.default_value.dump() + "]";
  return field.default_words.empty() ? text : text + " [" + field.default_words + "]";
}

std::string argument_name(const RequestField& field) {
  std::string name = field.name;
  for (char& letter : name) letter = static_cast<char>(std::toupper(letter));
  return name;
}

void add_option(CLI::App& command, RequestOptions& options, const RequestField& field) {
  const std::string option = "--" + requests::flag_of(field);
  if (holds_several(field)) {
    command.add_option(option, options.lists[field.name], help_of(field))->allow_extra_args(false);
    return;
  }
  const auto keep = [&options, name = field.name](const std::string& text) {
    options.texts[name] = text;
  };
  command
      .add_option_function<std::string>(field.required ? argument_name(field) : option, keep,
                                        help_of(field))
      ->required(field.required);
}

}  // namespace

void RequestOptions::add_to(CLI::App& command, requests::Commands which) {
  for (const RequestField& field : requests::request_fields())
    if (field.commands == requests::Commands::all ||
        (field.commands != requests::Commands::none && field.commands == which))
      add_option(command, *this, field);
  command.add_option("--data", data, "Folder of imported scenes");
  command.add_option("--device", device, "Vulkan device: part of its name, or its index");
  command.add_flag("--validation", validation, "Turn Vulkan's validation layer on");
}

std::string RequestOptions::text(const std::string& field) const {
  const auto found = texts.find(field);
  return found == texts.end() ? "" : found->second;
}

CanonicalRequest RequestOptions::read(bool measure) const {
  nlohmann::json request = nlohmann::json::object();
  std::vector<std::pair<std::string, std::string>> plain;
  for (const auto& [name, value] : texts) {
    if (requests::find_field(name)->kind == FieldKind::list)
      request[name] = list_in(name, value);
    else
      plain.emplace_back(name, value);
  }
  request.update(requests::request_from_text(plain));
  for (const auto& [name, entries] : lists)
    for (const std::string& entry : entries) add_entry(request, *requests::find_field(name), entry);
  request["measure"] = measure;
  return read_request(request, context());
}

}  // namespace penumbra::server::cli
