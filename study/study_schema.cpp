#include "study/study_schema.h"

#include <algorithm>
#include <span>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "renderer/embedded_file.h"
#include "renderer/error.h"
#include "requests/schema.h"
#include "study/faults.h"
#include "study/study.h"

namespace penumbra::study {

std::span<const EmbeddedFile> embedded_files();

namespace {

using nlohmann::json;

const valijson::Schema& compiled_schema() {
  static const auto schema = [] {
    auto result = std::make_unique<valijson::Schema>();
    valijson::SchemaParser parser;
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(study_schema()), *result);
    return result;
  }();
  return *schema;
}

std::string member_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

const json& resolve(const json& schema) {
  if (!schema.contains("$ref")) return schema;
  const auto pointer = schema.at("$ref").get<std::string>().substr(1);
  return study_schema().at(json::json_pointer(pointer));
}

/// Walks document and schema together, so that an unknown key is named by its own path: the
/// validator names only the object around it. The schema bounds the depth.
void find_unknown_keys(const json& value, const json& schema_or_reference, const std::string& path,
                       FaultList& faults) {
  const json& schema = resolve(schema_or_reference);
  if (value.is_array() && schema.contains("items")) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      find_unknown_keys(value[i], schema.at("items"), path + "[" + std::to_string(i) + "]", faults);
    }
  }
  if (!value.is_object() || !schema.contains("properties")) return;
  const json& properties = schema.at("properties");
  for (const auto& [key, member] : value.items()) {
    const auto known = properties.find(key);
    if (known == properties.end()) {
      std::string names;
      for (const auto& [name, unused] : properties.items()) {
        names += (names.empty() ? "" : ", ") + name;
      }
      faults.add(bad_value(member_path(path, key), "unknown key; known are " + names));
      continue;
    }
    find_unknown_keys(member, *known, member_path(path, key), faults);
  }
}

/// The validator says "Failed to match regex specified by 'pattern' constraint."; people look for
/// the rule in the schema's description.
std::string in_words(const std::string& description) {
  static const std::vector<std::pair<std::string, std::string>> words{
      {"Missing required property", "is incomplete: "},
      {"'pattern' constraint", "has characters that are not allowed here, or none"},
      {"'enum' constraint", "is none of the allowed words"},
      {"Value type not permitted", "is of the wrong kind"},
  };
  for (const auto& [sign, said] : words)
    if (description.find(sign) != std::string::npos)
      return said + (said.ends_with(": ") ? description : "");
  return description;
}

/// The validator's context is ["<root>", "[pages]", "[2]"].
std::string path_of(const std::vector<std::string>& context) {
  std::string path;
  for (const std::string& part : context) {
    if (part.empty() || part.front() != '[') continue;
    const std::string name = part.substr(1, part.size() - 2);
    const bool index = name.find_first_not_of("0123456789") == std::string::npos;
    path = index ? path + part : member_path(path, name);
  }
  return path;
}

/// The validator names what is wrong and every object around it; the innermost places are kept, the
/// deepest first. Objects with unknown keys were named before.
void find_innermost(valijson::ValidationResults& results, FaultList& faults) {
  std::vector<valijson::ValidationResults::Error> all;
  for (valijson::ValidationResults::Error error; results.popError(error);) all.push_back(error);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.context.size() > b.context.size();
  });
  for (const auto& error : all) {
    const auto path = path_of(error.context);
    const bool around =
        std::any_of(faults.all().begin(), faults.all().end(), [&](const Error& known) {
          return path.empty() || known.field == path ||
                 (known.field.starts_with(path) &&
                  (known.field[path.size()] == '.' || known.field[path.size()] == '['));
        });
    if (!around || faults.all().empty()) faults.add(bad_value(path, in_words(error.description)));
  }
}

}  // namespace

const json& study_schema() {
  static const json document = [] {
    json schema = json::parse(embedded_files().front().text);
    schema.at("properties").at("picture") = requests::picture_schema();
    return schema;
  }();
  return document;
}

void check_study_schema(const json& document) {
  if (!document.is_object()) throw bad_value("", "a study is a JSON object");
  FaultList faults;
  find_unknown_keys(document, study_schema(), "", faults);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (!validator.validate(compiled_schema(), valijson::adapters::NlohmannJsonAdapter(document),
                          &results))
    find_innermost(results, faults);
  faults.throw_if_any();
}

}  // namespace penumbra::study
