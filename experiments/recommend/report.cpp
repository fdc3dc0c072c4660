#include "experiments/recommend/report.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "experiments/recommend/savings.h"
#include "experiments/report/page.h"
#include "experiments/report/rows.h"
#include "figures/charts.h"

namespace penumbra::experiments::recommend {
namespace {

using nlohmann::json;

std::string mebibytes(double bytes) {
  return Cell(bytes / (1 << 20), 2).text + " MiB";
}

std::string file_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string verdict_of(const json& summary) {
  const json& pick = summary.at("recommendation");
  std::string text =
      pick.at("name").get<std::string>() + ": " + Cell(pick.at("frame_ms").get<double>(), 2).text +
      " ms a frame, " + Cell(pick.at("over_none").get<double>(), 2).text +
      " times the frame without shadows, " + mebibytes(pick.at("memory_bytes").get<double>()) +
      ", error " + Cell(pick.at("error").get<double>(), 4).text + " (" +
      summary.at("objective").at("words").get<std::string>() + ").";
  if (!pick.at("view").get<std::string>().empty())
    text += " Its worst view: " + pick.at("view").get<std::string>() + ".";
  if (!pick.at("fits"))
    text += " Nothing that was tried keeps the budget: this came closest in time.";
  return text;
}

void add_tried(Page& page, const json& summary) {
  std::vector<std::vector<Cell>> cells;
  for (const json& row : summary.at("tried"))
    cells.push_back({row.at("name").get<std::string>(),
                     {row.at("frame_ms").get<double>(), 3},
                     {row.at("memory_bytes").get<double>(), 0},
                     {row.at("error").get<double>(), 4},
                     row.at("fits") ? "yes" : "no"});
  page.table("What was tried on this scene, in order",
             {"technique and parameters", "frame ms", "bytes", "error", "keeps the budget"}, cells);
}

/// What was tried, by time and error: dashed, what nothing beats.
std::string trials_figure(const json& summary) {
  figures::Front chart;
  chart.frame.title = "What was tried";
  chart.frame.description = "Error against time of every trial; dashed, what nothing beats.";
  chart.horizontal = {.title = "frame, ms", .logarithmic = true};
  // People's ranks lie close together.
  chart.vertical = {.title = summary.at("objective").at("words"),
                    .logarithmic = summary.at("objective").at("name") != "perceived"};
  for (const json& row : summary.at("tried")) {
    const double error = row.at("error");
    if (!(error > 0.0)) continue;  // exact: it has no place on a logarithmic axis
    chart.points.push_back({row.at("frame_ms").get<double>(), error, chart.series.size(), {}});
    chart.series.push_back(row.at("name"));
  }
  chart.front = figures::lower_left_front(chart.points);
  return figures::draw(chart);
}

/// Pictures of trials by name, from the rows that have one.
std::vector<Page::Picture> pictures_of(const std::filesystem::path& folder,
                                       const std::vector<json>& rows,
                                       const std::vector<std::string>& names) {
  std::vector<Page::Picture> pictures;
  for (const std::string& name : names) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const json& each) {
      return is_done(each) && each.contains("picture") && each.at("name") == name;
    });
    if (row != rows.end())
      pictures.push_back({file_text(folder / row->at("picture").get<std::string>()), name});
  }
  return pictures;
}

void add_savings(Page& page, const json& summary) {
  page.heading("What the scene does not need");
  page.paragraph(
      "Each was measured beside the recommendation. It is worth it where the error of "
      "visibility rises by at most " +
      Cell(100.0 * granted_share, 0).text + "% or " + Cell(granted_least, 3).text +
      " and time or bytes fall.");
  std::vector<std::vector<Cell>> cells;
  for (const json& row : summary.at("savings"))
    cells.push_back({row.at("what").get<std::string>(),
                     row.at("why").get<std::string>(),
                     {row.at("saved_ms").get<double>(), 3},
                     {row.at("saved_bytes").get<double>(), 0},
                     {row.at("error_before").get<double>(), 4},
                     {row.at("error").get<double>(), 4},
                     row.at("taken")      ? "always done"
                     : row.at("worth_it") ? "yes"
                                          : "no"});
  page.table("Savings",
             {"what", "why", "saves ms", "saves bytes", "error before", "error then", "worth it"},
             cells);
}

void add_refused(Page& page, const json& summary) {
  page.heading("What cannot draw this scene");
  if (summary.at("refused").empty()) return page.paragraph("Nothing was refused.");
  std::vector<std::vector<Cell>> cells;
  for (const json& row : summary.at("refused"))
    cells.push_back({row.at("name").get<std::string>(), row.at("reason").get<std::string>()});
  page.table("Refused", {"technique and parameters", "why"}, cells);
}

std::string cases_csv(const Evaluation& evaluation) {
  std::string csv =
      csv_line({"scene", "size", "budget_times_none", "recommended", "fastest_at_equal_error",
                "time_regret", "error_regret", "fits", "probes"});
  for (const Case& each : evaluation.cases)
    csv += csv_line({each.scene, std::to_string(each.size), exact(each.budget), each.candidate,
                     each.fastest, exact(each.time_regret), exact(each.error_regret),
                     each.fits ? "true" : "false", std::to_string(each.probes)});
  return csv;
}

std::string percent(const Estimate& estimate) {
  return Cell(100.0 * estimate.mean, 1).text + "% (" + Cell(100.0 * estimate.low, 1).text + " to " +
         Cell(100.0 * estimate.high, 1).text + ")";
}

std::string regret_figure(const Evaluation& evaluation) {
  figures::DotPlot plot;
  plot.frame.title = "Regret in time at equal error";
  plot.frame.description = "Mean over budgets for each scene that was left out.";
  plot.axis = "more time than the fastest with no more error, %";
  plot.reference = 10.0;
  std::vector<std::string> scenes;
  for (const Case& each : evaluation.cases)
    if (std::find(scenes.begin(), scenes.end(), each.scene) == scenes.end())
      scenes.push_back(each.scene);
  for (const std::string& scene : scenes) {
    double sum = 0.0, count = 0.0;
    for (const Case& each : evaluation.cases)
      if (each.scene == scene) {
        sum += 100.0 * each.time_regret;
        count += 1.0;
      }
    plot.rows.push_back({scene, sum / count, std::nullopt});
  }
  const Estimate& all = evaluation.time_regret;
  plot.rows.push_back(
      {"all scenes", 100.0 * all.mean, figures::Interval{100.0 * all.low, 100.0 * all.high}});
  return figures::draw(plot);
}

}  // namespace

json write_report(const std::filesystem::path& folder, const json& device,
                  const std::string& command, const json& summary, const std::vector<json>& rows) {
  Page page("Which technique for " + summary.at("scene").get<std::string>());
  add_facts(page, device, command, rows);
  const json& budget = summary.at("budget");
  page.paragraph(
      "Budget: " + Cell(budget.at("ms").get<double>(), 2).text + " ms a frame" +
      (budget.at("bytes").is_null() ? std::string()
                                    : " and " + mebibytes(budget.at("bytes").get<double>())) +
      ". The model starts from " + summary.at("learnt_from_scenes").dump() +
      " measured scenes: a technique's error and time are those of the scene without shadows times "
      "a ratio. What promises most is tried on this scene, and every trial corrects the ratios.");
  page.heading("Recommendation");
  page.paragraph(verdict_of(summary));
  for (const json& note : summary.at("recommendation").at("notes"))
    page.paragraph("Note: " + note.get<std::string>());
  const std::string chosen = summary.at("recommendation").at("name");
  page.pictures(pictures_of(folder, rows, {chosen}));
  page.heading("What was tried");
  const std::string figure = trials_figure(summary);
  std::filesystem::create_directories(folder / "figures");
  write_report_file(folder / "figures" / "trials.svg", figure);
  page.figure(figure, "Error against time of what was tried; dashed, what nothing beats.");
  add_tried(page, summary);
  std::vector<std::string> tried;
  for (const json& row : summary.at("tried"))
    if (row.at("name") != chosen) tried.push_back(row.at("name"));
  page.pictures(pictures_of(folder, rows, tried));
  add_savings(page, summary);
  add_refused(page, summary);
  page.heading("All runs");
  add_rows(page, rows);
  write_report_file(folder / "results.csv", results_csv(rows));
  write_report_file(folder / "report.html", page.text());
  return {"results.csv", "figures/trials.svg", "report.html"};
}

json write_evaluation(const std::filesystem::path& folder, const std::string& command,
                      const std::string& objective, const Evaluation& evaluation) {
  std::filesystem::create_directories(folder / "figures");
  Page page("Recommendations on scenes that the model never saw");
  page.facts({{"Command", command},
              {"Error", objective},
              {"Regret in time at equal error", percent(evaluation.time_regret)},
              {"Error above the least that fits the budget, of that without shadows",
               percent(evaluation.error_regret)},
              {"The same without any probe",
               percent(evaluation.unprobed_time) + ", " + percent(evaluation.unprobed_error)},
              {"Budgets kept", Cell(100.0 * evaluation.fitting, 0).text + "%"},
              {"Probes of a scene", Cell(evaluation.mean_probes, 1).text + " of " +
                                        std::to_string(evaluation.candidates) + " candidates"}});
  page.paragraph(
      "Each scene is left out in turn; the model learns from the others, probes this one and "
      "recommends for budgets of several times the frame without shadows. Regret compares with "
      "everything that was measured of the scene. Intervals hold 95 of 100 draws of scenes. A "
      "search of everything also picks what noise made fast, so regrets are rather too large.");
  const std::string figure = regret_figure(evaluation);
  page.figure(figure, "Time over that of the fastest with no more error; dashed, one tenth.");
  std::vector<std::vector<Cell>> cells;
  for (const Case& each : evaluation.cases)
    cells.push_back({each.scene,
                     {static_cast<double>(each.size), 0},
                     {each.budget, 1},
                     each.candidate,
                     each.fastest,
                     {100.0 * each.time_regret, 1},
                     {100.0 * each.error_regret, 1},
                     each.fits ? "yes" : "no",
                     {static_cast<double>(each.probes), 0}});
  page.table("Every scene and budget",
             {"scene", "size", "budget, times none", "recommended", "fastest at equal error",
              "time regret %", "error regret, % of none", "keeps the budget", "probes"},
             cells);
  write_report_file(folder / "results.csv", cases_csv(evaluation));
  write_report_file(folder / "figures" / "regret.svg", figure);
  write_report_file(folder / "report.html", page.text());
  json summary = to_json(evaluation);
  summary["files"] = {"results.csv", "figures/regret.svg", "report.html"};
  summary["rows"] = evaluation.cases.size();
  return summary;
}

}  // namespace penumbra::experiments::recommend
