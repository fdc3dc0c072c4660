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

study::Measures measures_shown(const FrozenStudy& frozen,
                               const std::map<std::string, storage::FrozenPicture>& pictures) {
  study::Measures shown;
  for (const auto& page : frozen.study.pages) {
    if (!page.counted()) continue;
    const auto renders = study::page_renders(frozen.study, page);
    for (std::size_t i = 0; i < page.pictures.size(); ++i) {
      const auto found = pictures.find(request_key(renders.pictures.at(i)));
      if (found == pictures.end() || !found->second.measures.is_object()) continue;
      for (const auto& [name, value] : found->second.measures.items())
        shown.values[name][{page.id, page.pictures[i].id}] = value.get<double>();
    }
  }
  return shown;
}

}  // namespace penumbra::server::http
