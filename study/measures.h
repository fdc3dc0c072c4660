#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::study {

/// A measure of pictures that figures hold against perceived realism.
struct Measure {
  std::string name;   ///< column of the CSV
  std::string title;  ///< with its unit
  bool logarithmic = false;
  bool higher_is_better = false;
};

/// All that figures know, frame time first. The names are those of a sweep's results.csv.
const std::vector<Measure>& known_measures();

/// Name of the frame time, which the Pareto front needs.
inline constexpr const char* frame_time = "frame_ms_median";

/// What was measured of the pictures that were shown, by page id and picture id.
struct Measures {
  std::map<std::string, std::map<std::pair<std::string, std::string>, double>> values;

  bool empty() const { return values.empty(); }
  std::optional<double> find(const std::string& measure, const std::string& scene,
                             const std::string& technique) const;
};

/// Reads a CSV with the columns scene, technique and any of the known measures; others are ignored,
/// empty cells are missing. Throws unreadable naming line and column: no number, a picture twice,
/// no known measure.
Measures parse_measures(std::string_view text);

}  // namespace penumbra::study
