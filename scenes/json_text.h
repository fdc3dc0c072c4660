#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace penumbra::scenes {

/// JSON as text whatever bytes its strings have: what is no UTF-8 becomes U+FFFD. `indent` as
/// nlohmann's dump: -1 is one line.
inline std::string json_text(const nlohmann::json& value, int indent = -1) {
  return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace penumbra::scenes
