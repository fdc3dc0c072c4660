#include "study/statistics/objective.h"

#include "study/statistics/agreement.h"
#include "study/statistics/json.h"

namespace penumbra::study {

namespace {

using nlohmann::json;
using statistics::value_or_null;

/// One measure and the mean ranks of the same pictures of one scene.
struct SceneLists {
  std::string scene;
  std::vector<std::string> techniques;
  std::vector<double> measured;
  std::vector<double> ranks;
};

SceneLists lists_of(const json& scene, const Measures& measures, const std::string& name) {
  SceneLists lists;
  lists.scene = scene["scene"];
  for (const json& row : scene["techniques"]) {
    const auto value = measures.find(name, lists.scene, row["technique"]);
    if (!value || row["mean_rank"].is_null()) continue;
    lists.techniques.push_back(row["technique"]);
    lists.measured.push_back(*value);
    lists.ranks.push_back(row["mean_rank"]);
  }
  return lists;
}

json correlation_json(std::size_t n, const statistics::RankCorrelation& correlation) {
  json result = {{"n", n},
                 {"spearman", value_or_null(correlation.rho)},
                 {"kendall_tau_b", value_or_null(correlation.tau_b)}};
  if (!correlation.rho) result["reason"] = "fewer than two pictures that differ in both";
  return result;
}

/// Techniques that no other both beats in time and in rank.
json pareto_json(const SceneLists& lists) {
  json front = json::array();
  for (std::size_t i = 0; i < lists.ranks.size(); ++i) {
    bool beaten = false;
    for (std::size_t j = 0; j < lists.ranks.size(); ++j) {
      const bool no_worse =
          lists.measured[j] <= lists.measured[i] && lists.ranks[j] <= lists.ranks[i];
      beaten =
          beaten ||
          (no_worse && (lists.measured[j] < lists.measured[i] || lists.ranks[j] < lists.ranks[i]));
    }
    if (beaten) continue;
    front.push_back({{"technique", lists.techniques[i]},
                     {frame_time, lists.measured[i]},
                     {"mean_rank", lists.ranks[i]}});
  }
  return front;
}

}  // namespace

json objective_json(const json& part, const Measures& measures) {
  json result = {{"measures", json::object()}, {"pareto", json::array()}};
  for (const auto& [name, values] : measures.values) {
    json& entry = result["measures"][name];
    entry = {{"scenes", json::array()}};
    std::vector<statistics::RankedList> all;
    std::size_t pictures = 0;
    for (const json& scene : part["scenes"]) {
      const SceneLists lists = lists_of(scene, measures, name);
      if (lists.ranks.empty()) continue;
      const statistics::RankedList list{lists.measured, lists.ranks};
      json row = correlation_json(lists.ranks.size(), statistics::correlate_within({list}));
      row["scene"] = lists.scene;
      entry["scenes"].push_back(row);
      all.push_back(list);
      pictures += lists.ranks.size();
      if (name == frame_time) {
        result["pareto"].push_back({{"scene", lists.scene}, {"front", pareto_json(lists)}});
      }
    }
    entry["pooled_within_scenes"] = correlation_json(pictures, statistics::correlate_within(all));
  }
  return result;
}

}  // namespace penumbra::study
