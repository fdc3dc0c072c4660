// Requests written as text: URL queries and options.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include "renderer/error.h"
#include "requests/reader.h"

namespace penumbra::requests {
namespace {

using nlohmann::json;

std::uint64_t integer_from(const std::string& name, const std::string& text) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  errno = 0;
  const std::uint64_t value = digits ? std::strtoull(text.c_str(), nullptr, 10) : 0;
  if (!digits || errno == ERANGE)
    throw bad_value(name, name + " must be a whole number, not \"" + text + "\"");
  return value;
}

bool boolean_from(const std::string& name, const std::string& text) {
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  throw bad_value(name, name + " must be true or false, not \"" + text + "\"");
}

/// A finite number, or nothing.
std::optional<double> number_from(const std::string& text) {
  if (text.empty() || std::isspace(static_cast<unsigned char>(text.front()))) return {};
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != '\0' || !std::isfinite(value)) return {};
  return value;
}

/// "1,2,3" as numbers; empty where a part is none.
json list_from(const std::string& text) {
  json list = json::array();
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = number_from(text.substr(begin, end - begin));
    if (!number) return {};
    list.push_back(*number);
    begin = end + 1;
  }
  return list;
}

json change_value(const std::string& text) {
  if (const auto number = number_from(text)) return *number;
  if (text.find(',') != std::string::npos)
    if (json list = list_from(text); !list.is_null()) return list;
  json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

/// Entry of an object, made where it is not there yet. Where there is a value instead of the
/// object, the entry was given as a whole and in part.
json& entry_of(json& place, const std::string& key, const std::string& field) {
  if (!place.is_null() && !place.is_object())
    throw bad_value(field, field + " is given twice: as a whole and in part");
  return place[key];
}

json value_from_text(const RequestField& field, const std::string& text) {
  switch (field.kind) {
    case FieldKind::integer:
      return integer_from(field.name, text);
    case FieldKind::boolean:
      return boolean_from(field.name, text);
    case FieldKind::real:
      if (const auto number = number_from(text)) return *number;
      throw bad_value(field.name, field.name + " must be a number, not \"" + text + "\"");
    case FieldKind::list: {
      json list = json::parse(text, nullptr, false);
      if (!list.is_array()) throw bad_value(field.name, field.name + " must be a list in JSON");
      return list;
    }
    default:
      return text;
  }
}

/// The field of which `NAME.key` is a change, as in `light.key.intensity`, or null.
const RequestField* field_of_change(const std::string& name) {
  for (const RequestField& field : request_fields())
    if (field.kind == FieldKind::changes && name.starts_with(field.entry + ".")) return &field;
  return nullptr;
}

}  // namespace

std::string change_example(const RequestField& field) {
  std::string path;
  json value = field.example;
  while (value.is_object()) {
    path += (path.empty() ? "" : ".") + value.begin().key();
    value = json(value.begin().value());
  }
  std::string text;
  if (!value.is_array()) return path + "=" + value.dump();
  for (const json& number : value) text += (text.empty() ? "" : ",") + number.dump();
  return path + "=" + text;
}

void add_change(json& request, const RequestField& field, const std::string& path,
                const std::string& value) {
  const std::string place = field.name + "." + path;
  const std::size_t dot = path.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == path.size())
    throw bad_value(place, "a " + field.entry + " is changed by NAME.key=value, as in " +
                               change_example(field) + ", not \"" + path + "\"");
  // A key may lie deeper: NAME.extent.radius.
  json* object = &request[field.name][path.substr(0, dot)];
  std::size_t begin = dot + 1;
  for (std::size_t end = path.find('.', begin); end != std::string::npos;
       begin = end + 1, end = path.find('.', begin))
    object = &entry_of(*object, path.substr(begin, end - begin), place);
  json& entry = entry_of(*object, path.substr(begin), place);
  if (!entry.is_null()) throw bad_value(place, place + " is given twice");
  entry = change_value(value);
}

json request_from_text(const std::vector<std::pair<std::string, std::string>>& entries) {
  json request = json::object();
  std::set<std::string> seen;
  for (const auto& [name, value] : entries) {
    if (!seen.insert(name).second) throw bad_value(name, name + " is given twice");
    if (const RequestField* changed = field_of_change(name)) {
      add_change(request, *changed, name.substr(changed->entry.size() + 1), value);
      continue;
    }
    const RequestField* field = find_field(name);
    if (field && field->kind != FieldKind::parameters && field->kind != FieldKind::changes)
      request[name] = value_from_text(*field, value);
    else
      request["parameters"][name] = value;
  }
  return request;
}

}  // namespace penumbra::requests
