#pragma once

#include <httplib.h>

#include <nlohmann/json.hpp>
#include <string>

#include "renderer/error.h"

namespace penumbra::server::http {

/// Reads and decompresses the body. Throws too_large beyond `limit` bytes, counted after
/// decompression, and bad_value where it cannot be read. The length was checked with the head.
std::string read_body(const httplib::Request& request, const httplib::ContentReader& reader,
                      std::size_t limit);

/// Throws bad_value where path or query are no UTF-8 or hold NUL.
void check_text(const httplib::Request& request);

/// Parses JSON of at most 64 levels. Throws bad_value (field body).
nlohmann::json parse_json(const std::string& text);

/// Throws bad_value for anything but an object, and for keys that are not in `known`.
void check_keys(const nlohmann::json& object, std::initializer_list<const char*> known);

/// A number of the query, `otherwise` where it is absent. Throws bad_value naming the field.
double number_in_query(const httplib::Request& request, const std::string& name, double low,
                       double high, double otherwise);

/// An optional text of a body. Throws bad_value where it is something else.
std::string text_in(const nlohmann::json& body, const char* key, const std::string& otherwise);

}  // namespace penumbra::server::http
