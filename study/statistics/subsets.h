#pragma once

#include <cstddef>
#include <string>
#include <utility>
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

/// Maximal runs of neighbours of which no two differ, first and last member: what his tables show.
/// Where the tests contradict the order, a pair that does not differ shares no run.
std::vector<std::pair<std::size_t, std::size_t>> neighbouring_runs(
    const std::vector<std::vector<bool>>& different);

/// Compact letters: treatments share a letter exactly where they share a subset.
std::vector<std::string> compact_letters(const std::vector<std::vector<std::size_t>>& subsets,
                                         std::size_t treatments);

}  // namespace penumbra::study::statistics
