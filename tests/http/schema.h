#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace penumbra::server::http {

/// Fails the test where the value does not fit components/schemas/NAME of schema/openapi.yaml.
void expect_schema(const nlohmann::json& value, const std::string& name);

}  // namespace penumbra::server::http
