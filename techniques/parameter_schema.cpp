#include "techniques/parameter_schema.h"

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <variant>

#include "renderer/error.h"

namespace penumbra::techniques {
namespace {

nlohmann::json to_json(const ParameterValue& value) {
  return std::visit([](const auto& held) { return nlohmann::json(held); }, value);
}

const char* json_type(ParameterType type) {
  switch (type) {
    case ParameterType::boolean:
      return "boolean";
    case ParameterType::integer:
      return "integer";
    case ParameterType::real:
      return "number";
    case ParameterType::choice:
      return "string";
  }
  throw std::logic_error("a parameter has an unknown type");
}

nlohmann::json property_of(const Parameter& parameter) {
  nlohmann::json property{{"type", json_type(parameter.type)},
                          {"default", to_json(parameter.default_value)},
                          {"description", parameter.meaning}};
  if (parameter.type == ParameterType::choice) property["enum"] = parameter.choices;
  if (parameter.type == ParameterType::integer) {
    property["minimum"] = static_cast<std::int64_t>(parameter.minimum);
    property["maximum"] = static_cast<std::int64_t>(parameter.maximum);
  }
  if (parameter.type == ParameterType::real) {
    property["minimum"] = parameter.minimum;
    property["maximum"] = parameter.maximum;
  }
  if (parameter.only_with)
    property["x-only-with"] = {{parameter.only_with->name, parameter.only_with->values}};
  if (parameter.type == ParameterType::integer || parameter.type == ParameterType::real) {
    property["x-unit"] = parameter.unit;
    property["x-scale"] = parameter.scale == ParameterScale::logarithmic ? "logarithmic" : "linear";
  }
  return property;
}

ParameterValue from_json(const std::string& key, const nlohmann::json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return value.get<double>();
  if (value.is_number_unsigned() &&
      value.get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()})
    return value.get<double>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  throw bad_value(key, "parameter " + key + " must be true, false, a number or a string, not " +
                           value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

nlohmann::json parameter_schema(const std::vector<Parameter>& declared) {
  nlohmann::json properties = nlohmann::json::object();
  for (std::size_t order = 0; order < declared.size(); ++order) {
    nlohmann::json property = property_of(declared[order]);
    property["x-order"] = order;
    properties[declared[order].name] = std::move(property);
  }
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"type", "object"},
          {"properties", std::move(properties)},
          {"additionalProperties", false}};
}

ParameterValues values_from_json(const nlohmann::json& object) {
  if (!object.is_object()) throw bad_value("parameters", "parameters must be an object");
  ParameterValues values;
  for (const auto& [key, value] : object.items()) values[key] = from_json(key, value);
  return values;
}

nlohmann::json values_to_json(const ParameterValues& values) {
  nlohmann::json object = nlohmann::json::object();
  for (const auto& [name, value] : values) object[name] = to_json(value);
  return object;
}

}  // namespace penumbra::techniques
