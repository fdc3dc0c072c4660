#pragma once

#include <gtest/gtest.h>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/error.h"
#include "study/study.h"

namespace penumbra::study {

inline nlohmann::json thesis_document() {
  std::ifstream file(std::string(PENUMBRA_SOURCE_DIR) + "/studies/thesis-2007.json");
  return nlohmann::json::parse(file);
}

/// The field that an operation complains about; "(none)" where it does not.
inline std::string field_at_fault(const std::function<void()>& operation) {
  try {
    operation();
  } catch (const Error& error) {
    return error.field;
  }
  return "(none)";
}

}  // namespace penumbra::study
