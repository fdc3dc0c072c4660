#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace penumbra::study::statistics {

/// What is missing is null: JSON has no NaN.
template <typename T>
nlohmann::json value_or_null(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

inline nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

/// Adds why something is missing, where something is.
inline nlohmann::json with_reason(nlohmann::json object, const std::string& reason) {
  if (!reason.empty()) object["reason"] = reason;
  return object;
}

}  // namespace penumbra::study::statistics
