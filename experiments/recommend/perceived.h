#pragma once

#include <map>
#include <string>
#include <vector>

namespace penumbra::experiments::recommend {

/// Mean ranks over all scenes that people gave techniques, 1 most realistic.
struct Ranks {
  std::map<std::string, double> mean;  ///< by id of a technique or preset
  std::vector<std::string> unknown;    ///< names that this program does not have
};

/// From results.json of `penumbra statistics`, or, without a file, table 4.9 of van Sambeek 2007.
/// Throws unreadable (field "study").
Ranks perceived_ranks(const std::string& file);

}  // namespace penumbra::experiments::recommend
