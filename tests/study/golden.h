#pragma once

#include <gtest/gtest.h>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "study/statistics/table.h"

namespace penumbra::study {

/// A published or cross-computed case (R 4.2.2, scipy 1.10, PMCMRplus 1.9.10; the file names its
/// source), from tests/study/golden.
inline nlohmann::json golden(const std::string& id) {
  std::ifstream file(std::string(PENUMBRA_SOURCE_DIR) + "/tests/study/golden/" + id + ".json");
  return nlohmann::json::parse(file);
}

inline statistics::Table table_of(const nlohmann::json& rows) {
  statistics::Table table;
  for (const auto& row : rows) {
    table.emplace_back();
    for (const auto& cell : row) {
      table.back().push_back(cell.is_null() ? statistics::missing : cell.get<double>());
    }
  }
  return table;
}

/// Relative comparison with the golden file's own precision: 1e-6 for closed forms, 1e-5 for
/// p-values from numerical integration.
inline void expect_close(double value, double expected, double relative, const std::string& what) {
  EXPECT_NEAR(value, expected, relative * std::max(std::abs(expected), 1e-300)) << what;
}

}  // namespace penumbra::study
