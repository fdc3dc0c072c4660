#include "study/statistics/histograms.h"

#include <algorithm>

#include "study/statistics/omnibus.h"
#include "study/statistics/posthoc.h"

namespace penumbra::study::statistics {

using nlohmann::json;

void add_histograms(json& part, const SurveyData& data, const Selection& selection,
                    std::optional<std::size_t> scene) {
  std::size_t ranks = 0;
  std::vector<const PageAnswer*> pages;
  std::vector<bool> turned;
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    const PageAnswer& page = data.pages[i];
    if (!selection.used[i] || page.repeat > 0 || (scene && page.scene != *scene)) continue;
    pages.push_back(&page);
    turned.push_back(selection.turned[i]);
    ranks = std::max(ranks, page.pictures);
  }
  Table counts(data.techniques.size(), std::vector<double>(ranks, 0.0));
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const double highest = 2.0 * (static_cast<double>(pages[i]->pictures) + 1.0);
    for (std::size_t j = 0; j < counts.size(); ++j) {
      double doubled = pages[i]->doubled_ranks[j];
      if (is_missing(doubled)) continue;
      if (turned[i]) doubled = highest - doubled;
      const auto below = static_cast<std::size_t>(doubled) / 2;
      const auto above = (static_cast<std::size_t>(doubled) + 1) / 2;
      counts[j][below - 1] += 0.5;
      counts[j][above - 1] += 0.5;
    }
  }
  for (json& row : part["techniques"]) {
    const auto at = std::lower_bound(data.techniques.begin(), data.techniques.end(),
                                     row.at("technique").get<std::string>());
    row["histogram"] = counts.at(static_cast<std::size_t>(at - data.techniques.begin()));
  }
}

json critical_difference(const SurveyData& data, const ParticipantTable& table, double alpha) {
  const Table blocks = complete_blocks(table.scaled_ranks);
  const std::size_t treatments = table.techniques.size();
  json result = {{"alpha", alpha},
                 {"participants", blocks.size()},
                 {"value", nullptr},
                 {"mean_ranks", json::object()}};
  if (blocks.size() < 2 || treatments < 2) {
    result["reason"] = treatments < 2 ? "fewer than two techniques"
                                      : "fewer than two participants saw every technique";
    return result;
  }
  result["value"] = nemenyi_critical_difference(blocks.size(), static_cast<int>(treatments), alpha);
  const auto sums = rank_sums(blocks);
  for (std::size_t i = 0; i < treatments; ++i)
    result["mean_ranks"][data.techniques[table.techniques[i]]] =
        sums[i] / static_cast<double>(blocks.size());
  return result;
}

}  // namespace penumbra::study::statistics
