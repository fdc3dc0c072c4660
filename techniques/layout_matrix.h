#pragma once

#include <map>
#include <string>
#include <vector>

namespace penumbra::techniques {

/// The kinds of light that a technique draws with a layout of its map, as scene documents name
/// them.
struct LayoutRow {
  std::string technique;
  std::map<std::string, std::vector<std::string>> lights;  ///< by layout; none: it is not served
};

/// Every technique that has a map against every layout there is, as techniques require it.
std::vector<LayoutRow> layout_matrix();

}  // namespace penumbra::techniques
