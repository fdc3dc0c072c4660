#include "study/statistics/subsets.h"

#include <algorithm>

namespace penumbra::study::statistics {

namespace {

using Set = std::vector<std::size_t>;

/// Bron and Kerbosch (1973) with Tomita's pivot.
class CliqueSearch {
 public:
  explicit CliqueSearch(const std::vector<std::vector<bool>>& different_) : different(different_) {}

  std::vector<Set> run() {
    Set all(different.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    Set chosen;
    extend(chosen, all, {});
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  bool joined(std::size_t a, std::size_t b) const { return a != b && !different[a][b]; }

  Set neighbours_in(const Set& set, std::size_t of) const {
    Set result;
    std::copy_if(set.begin(), set.end(), std::back_inserter(result),
                 [&](std::size_t other) { return joined(of, other); });
    return result;
  }

  void extend(Set& chosen, Set candidates, Set excluded) {
    if (candidates.empty()) {
      if (excluded.empty() && !chosen.empty()) {
        found.push_back(chosen);
        std::sort(found.back().begin(), found.back().end());
      }
      return;
    }
    std::size_t pivot = candidates.front();
    std::size_t most = 0;
    for (const Set* set : {&candidates, &excluded}) {
      for (const std::size_t vertex : *set) {
        const std::size_t count = neighbours_in(candidates, vertex).size();
        if (count > most) {
          most = count;
          pivot = vertex;
        }
      }
    }
    const Set order = candidates;
    for (const std::size_t vertex : order) {
      if (joined(pivot, vertex)) continue;
      chosen.push_back(vertex);
      extend(chosen, neighbours_in(candidates, vertex), neighbours_in(excluded, vertex));
      chosen.pop_back();
      candidates.erase(std::find(candidates.begin(), candidates.end(), vertex));
      excluded.push_back(vertex);
    }
  }

  const std::vector<std::vector<bool>>& different;
  std::vector<Set> found;
};

}  // namespace

std::vector<Set> maximal_cliques(const std::vector<std::vector<bool>>& different) {
  return CliqueSearch(different).run();
}

std::string subset_letter(std::size_t index) {
  if (index < 26) return std::string(1, static_cast<char>('a' + index));
  if (index < 52) return std::string(1, static_cast<char>('A' + (index - 26)));
  return "(" + std::to_string(index + 1) + ")";
}

std::vector<std::pair<std::size_t, std::size_t>> neighbouring_runs(
    const std::vector<std::vector<bool>>& different) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  std::size_t end = 0;  // of the last run, one past its last member
  for (std::size_t first = 0; first < different.size(); ++first) {
    std::size_t next = first + 1;
    while (next < different.size() &&
           std::none_of(different[next].begin() + static_cast<long>(first),
                        different[next].begin() + static_cast<long>(next),
                        [](bool differs) { return differs; })) {
      ++next;
    }
    if (next > end) runs.emplace_back(first, next - 1);
    end = std::max(end, next);
  }
  return runs;
}

std::vector<std::string> compact_letters(const std::vector<Set>& subsets, std::size_t treatments) {
  std::vector<std::string> letters(treatments);
  for (std::size_t i = 0; i < subsets.size(); ++i) {
    for (const std::size_t member : subsets[i]) letters.at(member) += subset_letter(i);
  }
  return letters;
}

}  // namespace penumbra::study::statistics
