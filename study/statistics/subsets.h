#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace penumbra::study::statistics {

/// Maximal sets of treatments of which no two differ, the columns of tables 4.3 to 4.9 of van
/// Sambeek 2007. Neighbouring runs can contradict the tests behind them; maximal cliques cannot.
/// different[i][j] says that i and j differ (symmetric); members ascend, sets are in lexicographic
/// order.
std::vector<std::vector<std::size_t>> maximal_cliques(
    const std::vector<std::vector<bool>>& different);

/// Letter of the i-th subset: "a" to "z", "A" to "Z", then (53), (54), ...
std::string subset_letter(std::size_t index);

/// Compact letters: treatments share a letter exactly where they share a subset.
std::vector<std::string> compact_letters(const std::vector<std::vector<std::size_t>>& subsets,
                                         std::size_t treatments);

}  // namespace penumbra::study::statistics
