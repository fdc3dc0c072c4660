#include "study/report/figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "figures/charts.h"
#include "study/report/words.h"
#include "study/statistics/agreement.h"
#include "study/statistics/report.h"
#include "study/statistics/subsets.h"
#include "study/statistics/table.h"
#include "study/study.h"

namespace penumbra::study {

namespace {

using figures::fixed_text;
using figures::shown_number;
using nlohmann::json;
using report::number;

std::optional<figures::Interval> limits_of(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array() || found->size() != 2) return std::nullopt;
  if (!(*found)[0].is_number() || !(*found)[1].is_number()) return std::nullopt;
  return figures::Interval{(*found)[0].get<double>(), (*found)[1].get<double>()};
}

/// Letters, digits and dashes.
std::string file_name(const std::string& text) {
  std::string name;
  for (const char byte : text) {
    const bool upper = byte >= 'A' && byte <= 'Z';
    const bool kept = (byte >= 'a' && byte <= 'z') || (byte >= '0' && byte <= '9');
    if (upper)
      name += static_cast<char>(byte - 'A' + 'a');
    else if (kept)
      name += byte;
    else if (!name.empty() && name.back() != '-')
      name += '-';
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name.empty() ? "scene" : name;
}

class FigureMaker {
 public:
  FigureMaker(const json& report, const FigureOptions& options_)
      : options(options_), set(report.at("included_sets").at(options_.set)) {}

  std::vector<Figure> run() {
    add_part(set.at("overall"), "");
    if (set.at("scenes").size() > 1)
      for (const json& part : set.at("scenes")) add_part(part, part.at("scene"));
    if (!options.measures.empty()) add_measured();
    return std::move(made);
  }

 private:
  std::string label(const std::string& id) const {
    const auto found = options.labels.find(id);
    return found == options.labels.end() ? id : found->second;
  }

  figures::Frame frame(const std::string& title, double width_mm) const {
    return {title, "", options.width_mm > 0.0 ? options.width_mm : width_mm, "no data"};
  }

  void add(const std::string& kind, const std::string& title, const std::string& scene,
           std::string svg) {
    std::string name = kind + (scene.empty() ? "" : "-" + file_name(scene));
    for (int i = 2; !names.insert(name).second; ++i)
      name = kind + "-" + file_name(scene) + "-" + std::to_string(i);
    made.push_back({name, title, scene, std::move(svg)});
  }

  void add_part(const json& part, const std::string& scene) {
    const std::string of = scene.empty() ? ", all scenes" : ", " + scene;
    add("mean-ranks", "Mean ranks" + of, scene, mean_ranks(part, "Mean ranks" + of));
    add("critical-difference", "Critical differences" + of, scene,
        critical_difference(part, "Critical differences" + of));
    add("histograms", "Ranks given" + of, scene, histograms(part, "Ranks given" + of));
    add("worths", "Plackett-Luce worths" + of, scene, worths(part, "Plackett-Luce worths" + of));
  }

  static int highest_rank(const json& part) {
    std::size_t highest = 2;
    for (const json& row : part.at("techniques"))
      highest = std::max(highest, row.value("histogram", json::array()).size());
    return static_cast<int>(highest);
  }

  /// The report's order is that of weighted means; figures show unweighted ones.
  static std::vector<json> by_mean_rank(const json& part) {
    std::vector<json> rows = part.at("techniques");
    std::stable_sort(rows.begin(), rows.end(), [](const json& a, const json& b) {
      constexpr double last = std::numeric_limits<double>::infinity();
      return number(a, "mean_rank").value_or(last) < number(b, "mean_rank").value_or(last);
    });
    return rows;
  }

  std::string mean_ranks(const json& part, const std::string& title) const {
    figures::DotPlot plot;
    plot.frame = frame(title, figures::column_mm);
    plot.axis = "mean rank with 95% interval";
    plot.left_end = options.most_label;
    plot.right_end = options.least_label;
    plot.whole_numbers = figures::Range{1.0, static_cast<double>(highest_rank(part))};
    std::map<std::string, std::size_t> row_of;
    for (const json& row : by_mean_rank(part)) {
      const std::string id = row.at("technique");
      row_of[id] = plot.rows.size();
      plot.rows.push_back({label(id), number(row, "mean_rank"), limits_of(row, "ci95")});
      describe(plot.frame, label(id), number(row, "mean_rank"));
    }
    for (const json& subset : part.value("subsets", json::array())) {
      figures::DotPlot::Bar bar;
      bar.name = statistics::subset_letter(plot.bars.size());
      for (const json& id : subset) bar.rows.push_back(row_of.at(id));
      std::sort(bar.rows.begin(), bar.rows.end());
      plot.bars.push_back(std::move(bar));
    }
    return figures::draw(plot);
  }

  std::string critical_difference(const json& part, const std::string& title) const {
    figures::CriticalDifference diagram;
    diagram.frame = frame(title, figures::page_mm);
    const json& facts = part.at("critical_difference");
    diagram.frame.empty = facts.value("reason", "no data");
    const auto value = number(facts, "value");
    if (value) {
      diagram.difference = *value;
      diagram.note = "Nemenyi, α = " + figures::number_text(facts.at("alpha"), 4) +
                     ", n = " + std::to_string(facts.at("participants").get<int>());
      for (const auto& [id, rank] : facts.at("mean_ranks").items()) {
        diagram.items.push_back({label(id), rank});
        describe(diagram.frame, label(id), rank.get<double>());
      }
      std::vector<std::vector<bool>> different(diagram.items.size());
      for (std::size_t i = 0; i < diagram.items.size(); ++i)
        for (const auto& other : diagram.items)
          different[i].push_back(std::abs(diagram.items[i].rank - other.rank) >= *value);
      diagram.groups = statistics::maximal_cliques(different);
    }
    return figures::draw(diagram);
  }

  std::string histograms(const json& part, const std::string& title) const {
    figures::Histograms chart;
    chart.frame = frame(title, figures::page_mm);
    chart.horizontal = "rank, 1 is " + options.most_label + " (triangle: mean)";
    chart.vertical = "share of answers (%)";
    for (const json& row : by_mean_rank(part)) {
      std::vector<double> shares = row.at("histogram");
      double total = 0.0;
      for (const double count : shares) total += count;
      for (double& share : shares) share = total > 0.0 ? share / total : 0.0;
      chart.panels.push_back({label(row.at("technique")), shares, number(row, "mean_rank")});
      describe(chart.frame, label(row.at("technique")), number(row, "mean_rank"));
    }
    return figures::draw(chart);
  }

  std::string worths(const json& part, const std::string& title) const {
    figures::DotPlot plot;
    plot.frame = frame(title, figures::column_mm);
    const json& fit = part.at("plackett_luce");
    plot.frame.empty = "no worths: " + fit.value("reason", "no data");
    constexpr double normal_975 = 1.959963984540054;
    bool quasi = true;
    for (const json& row : fit.at("worths")) quasi = quasi && number(row, "quasi_se");
    const char* error = quasi ? "quasi_se" : "se";
    plot.axis =
        std::string("log worth with 95% interval (") + (quasi ? "quasi" : "standard") + " errors)";
    plot.left_end = options.least_label;
    plot.right_end = options.most_label;
    plot.reference = 0.0;
    for (const json& row : fit.at("worths")) {
      const auto worth = number(row, "log_worth");
      const auto se = number(row, error);
      std::optional<figures::Interval> reach;
      if (worth && se) reach = {*worth - normal_975 * *se, *worth + normal_975 * *se};
      plot.rows.push_back({label(row.at("technique")), worth, reach});
      describe(plot.frame, label(row.at("technique")), worth);
    }
    std::stable_sort(plot.rows.begin(), plot.rows.end(), [](const auto& a, const auto& b) {
      constexpr double last = -std::numeric_limits<double>::infinity();
      return a.value.value_or(last) > b.value.value_or(last);
    });
    return figures::draw(plot);
  }

  static void describe(figures::Frame& frame, const std::string& name,
                       const std::optional<double>& value) {
    frame.description += (frame.description.empty() ? "" : "; ") + name + " " +
                         (value ? fixed_text(*value, 2) : "no value");
  }

  /// Names of all techniques in the order of the overall part, so that marks are the same in every
  /// panel.
  std::vector<std::string> series_ids() const {
    std::vector<std::string> ids;
    for (const json& row : set.at("overall").at("techniques")) ids.push_back(row.at("technique"));
    return ids;
  }

  void add_measured() {
    for (const Measure& measure : known_measures()) {
      if (!options.measures.values.contains(measure.name)) continue;
      const std::string title = "Perceived realism against " + measure.title;
      add("perceived-by-" + file_name(measure.name), title, "", against(measure, title));
    }
    if (!options.measures.values.contains(frame_time)) return;
    add("pareto", "Frame time and perceived realism, all scenes", "",
        pareto(set.at("overall"), "", "Frame time and perceived realism, all scenes"));
    if (set.at("scenes").size() < 2) return;
    for (const json& part : set.at("scenes")) {
      const std::string title =
          "Frame time and perceived realism, " + part.at("scene").get<std::string>();
      add("pareto", title, part.at("scene"), pareto(part, part.at("scene"), title));
    }
  }

  figures::ScatterAxis rank_axis(int highest) const {
    return {"mean rank with 95% interval (top: " + options.most_label + ")", false, true,
            figures::Range{0.6, highest + 0.4}, true};
  }

  std::string against(const Measure& measure, const std::string& title) const {
    figures::Scatter chart;
    chart.frame = frame(title, figures::page_mm);
    chart.horizontal = {measure.title, measure.logarithmic, measure.higher_is_better, {}};
    const auto ids = series_ids();
    for (const auto& id : ids) chart.series.push_back(label(id));
    int highest = 2;
    for (const json& part : set.at("scenes")) {
      highest = std::max(highest, highest_rank(part));
      figures::Scatter::Panel panel;
      panel.label = part.at("scene");
      std::vector<double> measured;
      std::vector<double> perceived;
      for (const json& row : part.at("techniques")) {
        const std::string id = row.at("technique");
        const auto x = options.measures.find(measure.name, panel.label, id);
        const auto y = number(row, "mean_rank");
        if (!x || !y || (measure.logarithmic && !(*x > 0.0))) continue;
        const auto at = std::find(ids.begin(), ids.end(), id);
        panel.points.push_back(
            {*x, *y, static_cast<std::size_t>(at - ids.begin()), limits_of(row, "ci95")});
        measured.push_back(measure.higher_is_better ? -*x : *x);
        perceived.push_back(*y);
      }
      const auto rho = statistics::spearman(measured, perceived);
      const auto tau = statistics::kendall_tau_b(measured, perceived);
      if (rho && tau)
        panel.note = "ρ = " + shown_number(*rho, 2) + ", τ = " + shown_number(*tau, 2) + ", " +
                     std::to_string(measured.size()) + " pictures";
      chart.frame.description += (chart.frame.description.empty() ? "" : "; ") + panel.label +
                                 (panel.note.empty() ? "" : ": " + panel.note);
      chart.panels.push_back(std::move(panel));
    }
    chart.vertical = rank_axis(highest);
    return figures::draw(chart);
  }

  /// Of one scene; where `scene` is empty the median of the scenes' times.
  std::optional<double> time_of(const std::string& scene, const std::string& technique) const {
    if (!scene.empty()) return options.measures.find(frame_time, scene, technique);
    std::vector<double> times;
    for (const json& part : set.at("scenes"))
      if (const auto time = options.measures.find(frame_time, part.at("scene"), technique))
        times.push_back(*time);
    if (times.empty()) return std::nullopt;
    std::sort(times.begin(), times.end());
    const std::size_t half = times.size() / 2;
    return times.size() % 2 == 1 ? times[half] : 0.5 * (times[half - 1] + times[half]);
  }

  std::string pareto(const json& part, const std::string& scene, const std::string& title) const {
    figures::Front chart;
    chart.frame = frame(title, figures::column_mm);
    chart.frame.empty = "no frame times";
    chart.horizontal = {scene.empty() ? "frame time (ms, median of the scenes)" : "frame time (ms)",
                        true,
                        false,
                        {}};
    chart.vertical = rank_axis(highest_rank(part));
    const auto ids = series_ids();
    for (const auto& id : ids) chart.series.push_back(label(id));
    for (const json& row : part.at("techniques")) {
      const std::string id = row.at("technique");
      const auto time = time_of(scene, id);
      const auto rank = number(row, "mean_rank");
      if (!time || !rank || !(*time > 0.0)) continue;
      const auto at = std::find(ids.begin(), ids.end(), id);
      chart.points.push_back(
          {*time, *rank, static_cast<std::size_t>(at - ids.begin()), limits_of(row, "ci95")});
    }
    chart.front = figures::lower_left_front(chart.points);
    for (const std::size_t index : chart.front)
      describe(chart.frame, chart.series[chart.points[index].series], chart.points[index].y);
    return figures::draw(chart);
  }

  const FigureOptions& options;
  const json& set;
  std::set<std::string> names;
  std::vector<Figure> made;
};

}  // namespace

FigureOptions figure_options(const Study& study) {
  FigureOptions options;
  const std::string& language = study.languages.front();
  options.labels = report_options(study).labels;
  options.most_label = study.most_label.at(language);
  options.least_label = study.least_label.at(language);
  return options;
}

std::vector<Figure> figures_of(const json& report, const FigureOptions& options) {
  return FigureMaker(report, options).run();
}

}  // namespace penumbra::study
