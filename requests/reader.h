#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "requests/fields.h"

namespace penumbra::requests {

/// What a request says, defaults filled in. Without value and default, a text is empty, an object
/// or list is empty, and a number is missing.
struct RequestValues {
  nlohmann::json pictured;  ///< fields that the picture depends on
  nlohmann::json others;
};

/// Checks a request field by field. Throws bad_value, naming the field and what is allowed, for
/// unknown keys, wrong types and values out of range.
RequestValues read_fields(const nlohmann::json& request);

/// The value in the field's type. Throws bad_value as read_fields does.
nlohmann::json read_value(const RequestField& field, const nlohmann::json& value);

/// A request from names and values as text: URL queries. Names of no field are parameters;
/// `light.NAME.key` is an entry of `lights`, `camera.NAME.key` one of `cameras`. A name given twice
/// is a bad value.
nlohmann::json request_from_text(const std::vector<std::pair<std::string, std::string>>& entries);

/// Adds `NAME.key=value` to a field of changes. The value is a number, numbers separated by commas,
/// JSON, or a word.
void add_change(nlohmann::json& request, const RequestField& field, const std::string& path,
                const std::string& value);

/// A change as `NAME.key=value`, from the field's example.
std::string change_example(const RequestField& field);

}  // namespace penumbra::requests
