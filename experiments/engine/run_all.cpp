#include <algorithm>
#include <chrono>
#include <map>
#include <tuple>

#include "experiments/engine/engine.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

/// Runs that are timed before the first of them is judged; more of them would hold up progress.
constexpr std::size_t most_timed_first = 32;

}  // namespace

std::vector<json> run_all(Engine& engine, std::vector<Run> runs,
                          const std::function<void(const Progress&)>& progress) {
  if (runs.empty()) return {};               // nothing is told of nothing
  while (engine.begun() > 0) engine.next();  // of a list that was ended
  // Scenes keep the order in which they were first named.
  std::map<std::string, std::size_t> place;
  for (const Run& run : runs) place.try_emplace(run.scene, place.size());
  const auto order = [&](const Run& run) {
    return std::make_tuple(place.at(run.scene), run.width, run.height, run.light_samples, run.truth,
                           !is_baseline(run));
  };
  std::stable_sort(runs.begin(), runs.end(),
                   [&](const Run& a, const Run& b) { return order(a) < order(b); });
  const auto of_one_view = [](const Run& a, const Run& b) {
    return a.scene == b.scene && view_of(a) == view_of(b);
  };
  std::vector<json> rows;
  const auto start = Clock::now();
  const std::size_t before = engine.measured();
  const auto tell = [&](const std::string& what) {
    if (!progress) return;
    Progress now{rows.size(), runs.size(), engine.measured() - before, std::nullopt, what};
    if (now.measured > 0)
      now.left_s = std::chrono::duration<double>(Clock::now() - start).count() /
                   static_cast<double>(now.measured) * static_cast<double>(now.total - now.done);
    progress(now);
  };
  std::size_t timed = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    tell(run.scene + " " + run.technique + " " + std::to_string(run.width) + "x" +
         std::to_string(run.height));
    if (i == timed) {
      while (timed < runs.size() && timed < i + most_timed_first && of_one_view(run, runs[timed]))
        ++timed;
      engine.time_first({runs.begin() + static_cast<std::ptrdiff_t>(i),
                         runs.begin() + static_cast<std::ptrdiff_t>(timed)});
    }
    engine.begin(run);
    while (engine.begun() > engine.most_begun()) rows.push_back(engine.next());
  }
  while (engine.begun() > 0) rows.push_back(engine.next());
  tell("");
  return rows;
}

}  // namespace penumbra::experiments
