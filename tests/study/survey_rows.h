#pragma once

#include <optional>
#include <string>

#include "study/responses.h"

namespace penumbra::study {

inline ResponseRow row_of(const std::string& participant, const std::string& scene,
                          const std::string& technique, double rank,
                          std::optional<int> difficulty = 3) {
  ResponseRow row;
  row.participant = participant;
  row.scene = scene;
  row.technique = technique;
  row.rank = rank;
  row.difficulty = difficulty;
  return row;
}

/// "P07": names that sort as their numbers do.
inline std::string person_name(std::size_t index) {
  const std::string number = std::to_string(index);
  return "P" + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number;
}

}  // namespace penumbra::study
