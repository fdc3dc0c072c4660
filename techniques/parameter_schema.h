#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "renderer/parameters.h"

namespace penumbra::techniques {

/// JSON Schema (draft 2020-12) of an object of parameter values: per parameter type, default,
/// minimum, maximum, enum and description, and what forms and sweeps need besides: x-unit,
/// x-scale ("linear" or "logarithmic"), x-order (0 first, as declared) and x-only-with, the choices
/// of another parameter without which this one changes nothing ({"layout": ["cascaded"]}).
nlohmann::json parameter_schema(const std::vector<Parameter>& declared);

/// A JSON object of parameter values, as presets and requests have it. Throws bad_value naming the
/// key where a value is neither boolean, number nor string.
ParameterValues values_from_json(const nlohmann::json& object);

/// Keys in order of name; reals keep every digit.
nlohmann::json values_to_json(const ParameterValues& values);

}  // namespace penumbra::techniques
