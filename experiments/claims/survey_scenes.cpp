// What van Sambeek 2007 found of quality on his six scenes: table 4.2 measured again.
#include <algorithm>
#include <limits>

#include "experiments/claims/claim.h"
#include "experiments/claims/laboratory.h"
#include "figures/charts.h"
#include "study/statistics/agreement.h"
#include "study/van_sambeek_2007.h"

namespace penumbra::experiments::claims {
namespace {

bool is_of_volumes(const std::string& id) {
  return techniques::resolve(id).technique->family == "volume";
}

/// rms_y of his eight techniques: a row of scenes for each.
using ErrorTable = std::map<std::string, std::vector<double>>;

ErrorTable errors_at(Laboratory& lab, std::uint32_t size) {
  ErrorTable table;
  for (const std::string& scene : published::scenes)
    for (const auto& [technique, row] : published::rms_y)
      table[technique].push_back(
          lab.row(scene, technique, Truth::area, size, lab.scale().survey_samples).at("rms_y"));
  return table;
}

/// Errors of one scene; `scene` past the last: their mean over all.
double error_of(const ErrorTable& table, const std::string& id, std::size_t scene) {
  const std::vector<double>& row = table.at(id);
  if (scene < row.size()) return row[scene];
  double sum = 0.0;
  for (const double value : row) sum += value;
  return sum / static_cast<double>(row.size());
}

std::vector<double> column_of(const ErrorTable& table, std::size_t scene) {
  std::vector<double> values;
  for (const auto& [id, row] : table) values.push_back(error_of(table, id, scene));
  return values;
}

struct Ends {
  std::string nearest, furthest;
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
};

template <class Counts>
Ends ends_of(const ErrorTable& table, std::size_t scene, const Counts& counts) {
  Ends ends;
  for (const auto& [id, row] : table) {
    if (!counts(id)) continue;
    const double value = error_of(table, id, scene);
    if (value < ends.least) ends.nearest = id, ends.least = value;
    if (value > ends.most) ends.furthest = id, ends.most = value;
  }
  return ends;
}

bool any_technique(const std::string&) {
  return true;
}
bool is_of_maps(const std::string& id) {
  return !is_of_volumes(id);
}

/// Published errors against ours: a point for each technique and scene.
std::string figure_of(const ErrorTable& table) {
  figures::Scatter chart;
  chart.frame.title = "Table 4.2 and what is measured here";
  chart.frame.description = "rms_y of eight techniques on six scenes: published, and measured.";
  chart.series = published::scenes;
  chart.horizontal = {.title = "published in 2007, levels of 0 to 255", .logarithmic = true};
  chart.vertical = {.title = "measured, levels of 0 to 255", .logarithmic = true};
  auto& panel = chart.panels.emplace_back();
  for (const auto& [id, row] : published::rms_y)
    for (std::size_t scene = 0; scene < row.size(); ++scene)
      panel.points.push_back({row[scene], error_of(table, id, scene), scene, {}});
  return figures::draw(chart);
}

Outcome q11(Laboratory& lab) {
  const ErrorTable table = errors_at(lab, lab.scale().survey_size);
  const std::size_t all_scenes = published::scenes.size();
  Outcome outcome;
  for (const std::size_t scene : {all_scenes, std::size_t{3}, std::size_t{5}}) {
    const std::string place = scene < all_scenes ? published::scenes[scene] : "mean";
    const Ends volumes = ends_of(table, scene, is_of_volumes);
    const Ends maps = ends_of(table, scene, is_of_maps);
    outcome.number("volumes up to, " + place, volumes.most);
    outcome.number("maps from, " + place, maps.least);
    outcome.part(volumes.most < maps.least);
  }
  for (const std::size_t scene : {std::size_t{0}, std::size_t{4}}) {
    const Ends maps = ends_of(table, scene, is_of_maps);
    outcome.number("best map of " + published::scenes[scene] + ": " + maps.nearest, maps.least);
    outcome.part(maps.nearest == "pcss-nearest");
  }
  const Ends everything = ends_of(table, all_scenes, any_technique);
  outcome.number("furthest on the mean: " + everything.furthest, everything.most);
  outcome.part(everything.furthest == "vsm-2007");
  outcome.figure = figure_of(table);
  return outcome;
}

Outcome q12(Laboratory& lab) {
  const ErrorTable table = errors_at(lab, lab.scale().survey_size);
  const Ends maps = ends_of(table, 3, is_of_maps);
  Outcome outcome;
  const double volumes = error_of(table, "shadow-volumes", 3);
  outcome.number("shadow-volumes (1.59)", volumes);
  outcome.number("least of maps (12.17)", maps.least);
  outcome.number("most of maps (21.36)", maps.most);
  outcome.part(maps.least > 2.0 * volumes);
  return outcome;
}

Outcome q30(Laboratory& lab) {
  const std::uint32_t size = lab.scale().survey_size;
  const ErrorTable small = errors_at(lab, size / 2), large = errors_at(lab, size);
  Outcome outcome;
  for (std::size_t scene = 0; scene <= published::scenes.size(); ++scene) {
    const double tau =
        study::statistics::kendall_tau_b(column_of(small, scene), column_of(large, scene)).value();
    outcome.number("tau, " + (scene < published::scenes.size() ? published::scenes[scene] : "mean"),
                   tau);
    outcome.part(tau == 1.0);
  }
  outcome.note = "sizes " + std::to_string(size / 2) + " and " + std::to_string(size);
  return outcome;
}

Outcome q34(Laboratory& lab) {
  const ErrorTable table = errors_at(lab, lab.scale().survey_size);
  const std::vector<std::string> his{"pcf-bilinear", "shadow-map", "pcf-bilinear-3x3",
                                     "pcf-3x3",      "vsm-2007",   "pcss-nearest"};
  Outcome outcome;
  for (const std::string& id : his) outcome.number(id, error_of(table, id, 3));
  bool ordered = true;
  for (std::size_t i = 0; i + 1 < his.size(); ++i)
    ordered = ordered && error_of(table, his[i], 3) < error_of(table, his[i + 1], 3);
  outcome.part(ordered);
  return outcome;
}

Outcome q35(Laboratory& lab) {
  const ErrorTable table = errors_at(lab, lab.scale().survey_size);
  const Ends maps = ends_of(table, 4, is_of_maps);
  const double hard = error_of(table, "shadow-volumes", 4);
  const double soft = error_of(table, "soft-shadow-volumes-2007", 4);
  const double pcss = error_of(table, "pcss-nearest", 4);
  Outcome outcome;
  outcome.number("most of maps (4.28)", maps.most);
  outcome.number("shadow-volumes (4.81)", hard);
  outcome.number("pcss-nearest (1.86)", pcss);
  outcome.number("soft-shadow-volumes-2007 (4.40)", soft);
  outcome.part(maps.most < hard);
  outcome.part(pcss < soft);
  return outcome;
}

Outcome q36(Laboratory& lab) {
  const ErrorTable table = errors_at(lab, lab.scale().survey_size);
  Outcome outcome;
  for (const std::size_t scene : {std::size_t{3}, std::size_t{5}}) {
    const double hard = error_of(table, "shadow-volumes", scene);
    const double soft = error_of(table, "soft-shadow-volumes-2007", scene);
    outcome.number("hard, " + published::scenes[scene], hard);
    outcome.number("soft, " + published::scenes[scene], soft);
    outcome.part(soft > hard);
  }
  return outcome;
}

}  // namespace

std::vector<Claim> survey_scene_claims() {
  return {
      {"Q11", "S0 table 4.2",
       "volumes come nearest on the mean and on scenes 4 and 6; PCSS is the best map on scenes 1 "
       "and 5; VSM is furthest",
       "all volumes nearer than all maps, mean; scene 4; scene 6; best map of scene 1; of scene 5; "
       "furthest of all",
       q11},
      {"Q12", "S0 table 4.2", "on scene 4 volumes have 1.6 and maps 12 to 21",
       "the best map has over twice the error of volumes", q12},
      {"Q34", "S0 table 4.2, scene 4",
       "under a far light wide filters are farther: PCFb, SSM, PCFb3x3, PCF3x3, VSM, PCSS",
       "errors rise in this order", q34},
      {"Q35", "S0 table 4.2, scene 5",
       "under a near lamp every map beats hard volumes and PCSS beats soft ones",
       "all maps below hard volumes; PCSS below soft volumes", q35},
      {"Q36", "S0 table 4.2, scenes 4 and 6",
       "where penumbrae vanish soft volumes are farther than hard ones", "scene 4; scene 6", q36},
      {"Q30", "S0 4.1.2", "the order of techniques does not depend on the picture's size",
       "Kendall's tau of both orders is 1 on each scene and on the mean", q30},
  };
}

}  // namespace penumbra::experiments::claims
