#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace penumbra::scenes {

/// JSON as text whatever bytes its strings have: what is no UTF-8 becomes U+FFFD. `indent` as
/// nlohmann's dump: -1 is one line.
inline std::string json_text(const nlohmann::json& value, int indent = -1) {
  return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A vector as a JSON array of its components.
template <int N, class T>
nlohmann::json json_list(const glm::vec<N, T>& vector) {
  nlohmann::json list = nlohmann::json::array();
  for (int i = 0; i < N; ++i) list.push_back(vector[i]);
  return list;
}

}  // namespace penumbra::scenes
