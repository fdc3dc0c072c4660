#pragma once

#include <nlohmann/json.hpp>

#include "requests/fields.h"

namespace penumbra::requests {

/// JSON Schema of a request: its fields with types, meanings, ranges or choices, defaults and
/// examples. `x-order` is the place among the fields, `x-label` the name in the pages' forms,
/// `x-without` what is taken where a field without default is left out.
nlohmann::json request_schema();

/// JSON Schema of a study's `picture`: the fields that it may set, with the defaults they have
/// there.
nlohmann::json picture_schema();

/// A study's `picture` with every default filled in. Throws bad_value naming `picture.FIELD`.
nlohmann::json picture_settings(const nlohmann::json& picture);

/// OpenAPI's parameters of a request that is a URL's query.
nlohmann::json query_parameters();

}  // namespace penumbra::requests
