#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/stability/search.h"

namespace penumbra::experiments::stability {

/// How far a technique holds along one axis, as results.csv says it.
struct SafeRange {
  std::string technique;
  std::string axis;
  std::optional<double> holds;  ///< the last value that does; empty where none does
  std::optional<double> ends;   ///< the first that does not; empty: all hold
  bool refused = false;         ///< an error says so there
  std::string cause;            ///< what happens at `ends`
};

SafeRange safe_range_of(const Finding& finding);

/// Reads results.csv of `penumbra stability`. Throws unreadable, or bad_value with line and column.
std::vector<SafeRange> read_safe_ranges(const std::string& csv);

/// The page of all techniques, in Markdown: a table each of the axes that end, with what happens
/// there, whether the method requires it, and why.
std::string safe_ranges_page(const std::vector<SafeRange>& ranges);

/// What the page of a technique quotes: one paragraph of Markdown, its lines at most 110 bytes
/// long.
std::string safe_ranges_quote(const std::string& technique, const std::vector<SafeRange>& ranges);

}  // namespace penumbra::experiments::stability
