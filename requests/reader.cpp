#include "requests/reader.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/error.h"

namespace penumbra::requests {
namespace {

using nlohmann::json;

constexpr std::size_t max_text = 4096;  // characters: scene names may be paths

std::string shown(const json& value) {
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

[[noreturn]] void refuse(const RequestField& field, const std::string& allowed, const json& value) {
  throw bad_value(field.name, field.name + " must be " + allowed + ", not " + shown(value));
}

std::string read_text(const RequestField& field, const json& value) {
  if (!value.is_string()) refuse(field, "a text", value);
  std::string text = value.get<std::string>();
  if (text.size() > max_text || text.find('\0') != std::string::npos)
    throw bad_value(field.name, field.name + " is too long or holds a zero character");
  if (field.required && text.empty()) throw bad_value(field.name, field.name + " is empty");
  return text;
}

/// Whole numbers from zero that JSON keeps exactly; 3.0 is one.
std::optional<std::uint64_t> whole_number(const json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    return number < 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(number));
  }
  if (!value.is_number_float()) return {};
  const double real = value.get<double>();
  if (!(real >= 0.0 && real <= 0x1p53) || real != std::floor(real)) return {};
  return static_cast<std::uint64_t>(real);
}

std::uint64_t read_choice(const RequestField& field, const json& value) {
  const auto number = whole_number(value);
  const auto& allowed = field.allowed;
  if (number && std::find(allowed.begin(), allowed.end(), *number) != allowed.end()) return *number;
  std::string list;
  for (const auto choice : allowed) list += (list.empty() ? "" : ", ") + std::to_string(choice);
  refuse(field, "one of " + list, value);
}

std::uint64_t read_integer(const RequestField& field, const json& value) {
  if (!field.allowed.empty()) return read_choice(field, value);
  const auto low = static_cast<std::uint64_t>(field.minimum.value());
  const auto high = static_cast<std::uint64_t>(field.maximum.value());
  const auto number = whole_number(value);
  if (!number || *number < low || *number > high)
    refuse(field, "an integer from " + std::to_string(low) + " to " + std::to_string(high), value);
  return *number;
}

double read_real(const RequestField& field, const json& value) {
  const double low = field.minimum.value(), high = field.maximum.value();
  const double number = value.is_number() ? value.get<double>() : low - 1.0;
  if (!(number >= low && number <= high))
    refuse(field, "a number from " + json(low).dump() + " to " + json(high).dump(), value);
  return number + 0.0;  // -0 and 0 are one number
}

/// Null: there is none.
json without_value(const RequestField& field) {
  if (!field.default_value.is_null()) return field.default_value;
  switch (field.kind) {
    case FieldKind::text:
      return "";
    case FieldKind::parameters:
    case FieldKind::changes:
      return json::object();
    case FieldKind::list:
      return json::array();
    default:
      return nullptr;
  }
}

void refuse_unknown_keys(const json& request) {
  for (const auto& [key, value] : request.items()) {
    if (find_field(key)) continue;
    std::string known;
    for (const RequestField& field : request_fields())
      known += (known.empty() ? "" : ", ") + field.name;
    throw bad_value(key, "unknown key \"" + key + "\"; a request has " + known);
  }
}

}  // namespace

json read_value(const RequestField& field, const json& value) {
  switch (field.kind) {
    case FieldKind::text:
      return read_text(field, value);
    case FieldKind::integer:
      return read_integer(field, value);
    case FieldKind::real:
      return read_real(field, value);
    case FieldKind::boolean:
      if (!value.is_boolean()) refuse(field, "true or false", value);
      return value;
    case FieldKind::parameters:
    case FieldKind::changes:
      if (!value.is_object()) refuse(field, "an object", value);
      return value;
    case FieldKind::list:
      if (!value.is_array()) refuse(field, "a list", value);
      return value;
  }
  throw std::logic_error("field " + field.name + " is of an unknown kind");
}

RequestValues read_fields(const json& request) {
  if (!request.is_object())
    throw bad_value("", "a request is a JSON object, this is " + std::string(request.type_name()));
  RequestValues values{json::object(), json::object()};
  for (const RequestField& field : request_fields()) {
    const auto given = request.find(field.name);
    const bool missing = given == request.end() || given->is_null();
    if (missing && field.required) throw bad_value(field.name, "\"" + field.name + "\" is missing");
    json value = missing ? without_value(field) : read_value(field, *given);
    if (!value.is_null())
      (field.pictured ? values.pictured : values.others)[field.name] = std::move(value);
  }
  refuse_unknown_keys(request);
  return values;
}

}  // namespace penumbra::requests
