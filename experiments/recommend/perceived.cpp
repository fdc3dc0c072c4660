#include "experiments/recommend/perceived.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "renderer/error.h"
#include "study/van_sambeek_2007.h"
#include "techniques/registry.h"

namespace penumbra::experiments::recommend {
namespace {

using nlohmann::json;

std::map<std::string, double> published_ranks() {
  std::map<std::string, double> ranks;
  for (const auto& table : published::ranking_tables)
    if (table.scene.empty())
      for (const auto& row : table.rows) ranks[row.technique] = row.mean;
  return ranks;
}

std::map<std::string, double> ranks_in(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error("unreadable", "cannot read " + file, "study");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  std::map<std::string, double> ranks;
  try {
    for (const json& row :
         json::parse(text).at("included_sets").at("all").at("overall").at("techniques"))
      ranks[row.at("technique").get<std::string>()] = row.at("weighted_mean_rank").get<double>();
  } catch (const json::exception&) {
    throw Error("unreadable", file + " is no results.json of `penumbra statistics`", "study");
  }
  return ranks;
}

}  // namespace

Ranks perceived_ranks(const std::string& file) {
  Ranks ranks;
  for (const auto& [name, mean] : file.empty() ? published_ranks() : ranks_in(file)) {
    try {
      techniques::resolve(name);
      ranks.mean[name] = mean;
    } catch (const Error&) {
      ranks.unknown.push_back(name);
    }
  }
  return ranks;
}

}  // namespace penumbra::experiments::recommend
