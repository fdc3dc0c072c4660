#include "requests/schema.h"

#include <stdexcept>

#include "renderer/error.h"
#include "requests/reader.h"

namespace penumbra::requests {
namespace {

using nlohmann::json;

const char* json_type(FieldKind kind) {
  switch (kind) {
    case FieldKind::text:
      return "string";
    case FieldKind::integer:
      return "integer";
    case FieldKind::real:
      return "number";
    case FieldKind::boolean:
      return "boolean";
    case FieldKind::parameters:
    case FieldKind::changes:
      return "object";
    case FieldKind::list:
      return "array";
  }
  throw std::logic_error("a field of requests is of an unknown kind");
}

std::string description_of(const RequestField& field) {
  std::string text = field.meaning + ".";
  if (!field.more.empty()) text += " " + field.more;
  if (!field.default_words.empty()) text += " Left out: " + field.default_words + ".";
  return text;
}

/// The number as people write it in the field's type: 1, not 1.0.
json written(const RequestField& field, double number) {
  if (field.kind == FieldKind::real) return number;
  return static_cast<std::int64_t>(number);
}

json field_schema(const RequestField& field) {
  json schema{{"type", json_type(field.kind)}, {"description", description_of(field)}};
  if (field.kind == FieldKind::list) {
    schema["items"] = {{"type", "object"}};
    schema["maxItems"] = written(field, field.maximum.value());
  } else {
    if (field.minimum) schema["minimum"] = written(field, *field.minimum);
    if (field.maximum) schema["maximum"] = written(field, *field.maximum);
  }
  if (!field.allowed.empty()) schema["enum"] = field.allowed;
  if (!field.default_value.is_null()) schema["default"] = field.default_value;
  if (!field.example.is_null()) schema["examples"] = json::array({field.example});
  return schema;
}

/// OpenAPI's parameter of a key of a light or camera. NAME and key are the caller's.
json change_parameter(const RequestField& field) {
  return {{"name", field.entry + ".NAME.key"},
          {"in", "query"},
          {"description", field.meaning + ": " + field.entry + "." + change_example(field)},
          {"schema", {{"type", "string"}}}};
}

}  // namespace

json request_schema() {
  json properties = json::object();
  json required = json::array();
  for (const RequestField& field : request_fields()) {
    json schema = field_schema(field);
    schema["x-order"] = properties.size();
    if (!field.label.empty()) schema["x-label"] = field.label;
    if (!field.default_words.empty()) schema["x-without"] = field.default_words;
    properties[field.name] = std::move(schema);
    if (field.required) required.push_back(field.name);
  }
  return {{"type", "object"},
          {"required", required},
          {"properties", properties},
          {"additionalProperties", false}};
}

json picture_schema() {
  json properties = json::object();
  for (const RequestField& field : request_fields()) {
    if (field.in_studies.is_null()) continue;
    json schema = field_schema(field);
    schema["default"] = field.in_studies;
    schema.erase("examples");
    properties[field.name] = std::move(schema);
  }
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
}

json picture_settings(const json& picture) {
  json settings = json::object();
  for (const RequestField& field : request_fields()) {
    if (field.in_studies.is_null()) continue;
    const auto given = picture.find(field.name);
    try {
      settings[field.name] = given == picture.end() ? field.in_studies : read_value(field, *given);
    } catch (const Error& error) {
      throw bad_value("picture." + field.name, error.what());
    }
  }
  return settings;
}

json query_parameters() {
  json parameters = json::array();
  for (const RequestField& field : request_fields()) {
    if (field.kind == FieldKind::parameters) continue;
    if (field.kind == FieldKind::changes) {
      parameters.push_back(change_parameter(field));
      continue;
    }
    json parameter{{"name", field.name}, {"in", "query"}, {"required", field.required}};
    json schema = field_schema(field);
    parameter["description"] = std::move(schema["description"]);
    schema.erase("description");
    if (field.kind == FieldKind::list)
      parameter["content"]["application/json"]["schema"] = schema;
    else
      parameter["schema"] = schema;
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

}  // namespace penumbra::requests
