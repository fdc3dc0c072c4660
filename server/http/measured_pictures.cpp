#include "server/http/measured_pictures.h"

namespace penumbra::server::http {

using nlohmann::json;

json measures_of(const RenderRecord& record) {
  if (record.cost.is_null() || record.quality.is_null()) return nullptr;
  auto measured = json::object();
  if (record.quality.value("reference_id", "") == record.id) return measured;
  const auto take = [&](const std::string& name, const json& part, const char* place) {
    const json::json_pointer pointer(place);
    if (part.contains(pointer) && part.at(pointer).is_number()) measured[name] = part.at(pointer);
  };
  for (const auto& measure : study::known_measures()) {
    if (measure.name == study::frame_time)
      take(measure.name, record.cost, "/frame_ms/median");
    else
      take(measure.name, record.quality, ("/" + measure.name).c_str());
  }
  return measured;
}

namespace {

/// By name, the mean over all views of a picture; without those that some view lacks.
std::map<std::string, double> mean_of_views(
    const std::vector<json>& views, const std::map<std::string, storage::FrozenPicture>& pictures) {
  std::map<std::string, std::pair<double, std::size_t>> sums;  // and in how many views
  for (const json& request : views) {
    const auto found = pictures.find(request_key(request));
    if (found == pictures.end() || !found->second.measures.is_object()) return {};
    for (const auto& [name, value] : found->second.measures.items()) {
      auto& [sum, count] = sums[name];
      sum += value.get<double>();
      ++count;
    }
  }
  std::map<std::string, double> means;
  for (const auto& [name, sum] : sums)
    if (sum.second == views.size()) means[name] = sum.first / static_cast<double>(views.size());
  return means;
}

}  // namespace

study::Measures measures_shown(const FrozenStudy& frozen,
                               const std::map<std::string, storage::FrozenPicture>& pictures) {
  study::Measures shown;
  for (const auto& page : frozen.study.pages) {
    if (!page.counted()) continue;
    const auto renders = study::page_renders(frozen.study, page);
    for (std::size_t i = 0; i < page.pictures.size(); ++i)
      for (const auto& [name, value] : mean_of_views(renders.pictures.at(i), pictures))
        shown.values[name][{page.id, page.pictures[i].id}] = value;
  }
  return shown;
}

}  // namespace penumbra::server::http
