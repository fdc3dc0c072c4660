#include "experiments/report/ranks.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "experiments/engine/engine.h"
#include "renderer/error.h"
#include "study/van_sambeek_2007.h"
#include "techniques/registry.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;

struct Part {
  std::map<std::string, double> mean;
  bool of_scene = false;
};

Part published(const std::string& scene) {
  const auto& tables = published::ranking_tables;
  const auto table_of = [&](const std::string& name) {
    return std::find_if(tables.begin(), tables.end(),
                        [&](const auto& table) { return table.scene == name; });
  };
  const auto own = scene.empty() ? tables.end() : table_of(scene);
  Part part{{}, own != tables.end()};
  for (const auto& row : (part.of_scene ? own : table_of(""))->rows)
    part.mean[row.technique] = row.mean;
  return part;
}

Part part_in(const std::string& file, const std::string& scene) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error("unreadable", "cannot read " + file, "study");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  try {
    const json results = json::parse(text);
    const json& all = results.at("included_sets").at("all");
    const json* part = &all.at("overall");
    for (const json& one : all.at("scenes"))
      if (one.at("scene") == scene) part = &one;
    Part found{{}, part != &all.at("overall")};
    for (const json& row : part->at("techniques"))
      if (!row.at("weighted_mean_rank").is_null())
        found.mean[row.at("technique").get<std::string>()] = row.at("weighted_mean_rank");
    return found;
  } catch (const json::exception&) {
    throw Error("unreadable", file + " is no results.json of `penumbra statistics`", "study");
  }
}

}  // namespace

Ranks perceived_ranks(const std::string& study, const std::string& scene) {
  const Part part = study == published_ranks ? published(scene) : part_in(study, scene);
  Ranks ranks;
  ranks.of_scene = part.of_scene;
  for (const auto& [name, mean] : part.mean) {
    try {
      const NamedTechnique named = read_technique(name);
      techniques::resolve(named.id, named.parameters);
      ranks.mean[name] = mean;
    } catch (const Error&) {
      ranks.unknown.push_back(name);
    }
  }
  if (ranks.mean.empty())
    throw bad_value("study", "people have ranked no technique of this program in this study");
  return ranks;
}

}  // namespace penumbra::experiments
