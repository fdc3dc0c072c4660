#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "renderer/embedded_file.h"

namespace penumbra::server::http {

// Files compiled into the program.
std::span<const EmbeddedFile> embedded_api();        ///< schema/openapi.yaml
std::span<const EmbeddedFile> embedded_studies();    ///< studies/*.json
std::span<const EmbeddedFile> embedded_templates();  ///< studies/templates/*.json
std::span<const EmbeddedFile> embedded_pages();      ///< web/**

/// schema/openapi.yaml as JSON, with what follows from the fields of requests (requests/schema.h).
/// Merge keys (<<) are resolved.
const nlohmann::json& api_document();

/// YAML 1.2 (core schema) as JSON. Throws bad_value naming line and column.
nlohmann::json json_of_yaml(const std::string& text);

}  // namespace penumbra::server::http
