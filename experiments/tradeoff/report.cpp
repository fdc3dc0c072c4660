#include "experiments/tradeoff/report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

#include "experiments/report/rows.h"
#include "experiments/tradeoff/tradeoff.h"
#include "figures/charts.h"
#include "scenes/json_text.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;

/// Errors that a table asks for: shares of the error without any shadows.
constexpr double asked_shares[] = {0.5, 0.25, 0.125, 0.0625};

std::string settings_of(const json& row) {
  std::string text = row.at("name");
  for (const auto& [name, value] : row.at("given").items())
    text += " " + name + "=" +
            (value.is_string() ? value.get<std::string>() : scenes::json_text(value));
  return text;
}

std::vector<std::string> techniques_in(const std::vector<json>& rows) {
  std::vector<std::string> names;
  for (const json& row : rows)
    if (std::find(names.begin(), names.end(), row.at("technique")) == names.end())
      names.push_back(row.at("technique"));
  return names;
}

bool is_none(const json& row) {
  return row.at("family") == "none";
}

std::string front_figure(const std::vector<json>& rows, const Objective& objective) {
  figures::Front chart;
  chart.frame.title = objective.by_people ? "Ranks against time"
                                          : std::string("Error against time: ") + objective.key;
  chart.frame.description = objective.by_people
                                ? "What people ranked; dashed, the points that nothing beats."
                                : "Each technique's own front over its parameters; dashed, the "
                                  "points that nothing beats.";
  chart.horizontal = {.title = "frame, ms", .logarithmic = true};
  chart.vertical = {.title = objective.words, .logarithmic = !objective.by_people};
  std::vector<json> all;
  for (const std::string& name : techniques_in(rows)) {
    std::vector<json> own;
    for (const json& row : rows)
      if (row.at("technique") == name) own.push_back(row);
    const std::size_t series = chart.series.size();
    bool any = false;
    for (const std::size_t index : front_rows(own, objective.key)) {
      const double error = number_of(own[index], objective.key);
      // A logarithmic axis has no zero: exact pictures are in the table.
      if (!(error > 0.0)) continue;
      chart.points.push_back({number_of(own[index], "frame_ms"), error, series, {}});
      any = true;
    }
    if (any) chart.series.push_back(name);
  }
  chart.front = figures::lower_left_front(chart.points);
  return figures::draw(chart);
}

/// The fastest row of a technique whose error is at most `error`.
const json* fastest(const std::vector<json>& rows, const std::string& technique, const char* key,
                    double error) {
  const json* best = nullptr;
  for (const json& row : rows) {
    if (!is_done(row) || row.at("technique") != technique || !(number_of(row, key) <= error))
      continue;
    if (best == nullptr || number_of(row, "frame_ms") < number_of(*best, "frame_ms")) best = &row;
  }
  return best;
}

void add_needs(Page& page, const std::vector<json>& rows, const Objective& objective) {
  const auto none = std::find_if(rows.begin(), rows.end(),
                                 [](const json& row) { return is_none(row) && is_done(row); });
  if (none == rows.end()) return;
  const double without = number_of(*none, objective.key);
  std::vector<std::string> heads{"technique"};
  for (const double share : asked_shares) {
    const std::string text = Cell(share * without, 4).text;
    heads.push_back("ms for " + text);
    heads.push_back("with");
  }
  std::vector<std::vector<Cell>> cells;
  for (const std::string& name : techniques_in(rows)) {
    auto& line = cells.emplace_back();
    line.emplace_back(name);
    for (const double share : asked_shares) {
      const json* row = fastest(rows, name, objective.key, share * without);
      if (row == nullptr) {
        line.emplace_back("not reached");
        line.emplace_back("");
      } else {
        line.emplace_back(number_of(*row, "frame_ms"), 3);
        line.emplace_back(settings_of(*row));
      }
    }
  }
  page.table(
      std::string("What each technique needs for a half, a quarter, an eighth and a sixteenth "
                  "of the error without shadows: ") +
          objective.key,
      heads, cells);
}

void add_words(Page& page, const Ranks& ranks) {
  std::string text =
      "Ranks are those that people gave in a study, by the technique or preset that it showed; "
      "what the search found has none.";
  text += ranks.of_scene ? " They are of this scene."
                         : " People did not see this scene: they are of all scenes of the study.";
  for (const std::string& name : ranks.unknown)
    text += " " + name + " is no technique of this program.";
  page.paragraph(text);
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string caption_of(const json& row) {
  return settings_of(row) + ": " + Cell(number_of(row, "frame_ms"), 2).text + " ms, visibility " +
         Cell(number_of(row, "visibility_rms"), 4).text + ", FLIP " +
         Cell(number_of(row, "flip"), 4).text;
}

/// Writes a report's common files and lists them.
class Files {
 public:
  explicit Files(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_ / "figures");
  }
  void figure(Page& page, const std::string& name, const std::string& svg,
              const std::string& caption) {
    write("figures/" + name + ".svg", svg);
    page.figure(svg, caption);
  }
  void write(const std::string& name, const std::string& bytes) {
    write_report_file(folder_ / name, bytes);
    names_.push_back(name);
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<std::size_t> front_rows(const std::vector<json>& rows, const std::string& error) {
  std::vector<figures::ScatterPoint> points;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double ms = number_of(rows[i], "frame_ms"), value = number_of(rows[i], error.c_str());
    if (!is_done(rows[i]) || !std::isfinite(ms) || !std::isfinite(value)) continue;
    points.push_back({ms, value, 0, {}});
    place.push_back(i);
  }
  std::vector<std::size_t> front;
  for (const std::size_t index : figures::lower_left_front(points)) front.push_back(place[index]);
  return front;
}

json write_tradeoff_report(const std::filesystem::path& folder, const json& device,
                           const std::string& command, const std::vector<json>& rows,
                           const Ranks& ranks) {
  Files files(folder);
  Page page("Error against time");
  add_facts(page, device, command, rows);
  page.paragraph(
      "Errors are against the reference at the same size, by exact visibility of points of every "
      "light. The search over a technique's parameters starts at the defaults, takes every single "
      "step from them (another choice; twice or half of a number), and goes on from points that "
      "none of the technique's beats in time and in one of the three errors, with the parameters "
      "whose steps have led to such points, until its budget of runs is spent. It is no full grid: "
      "a better point may exist that needs two steps which do not help alone.");
  json fronts = json::object();
  std::set<std::size_t> shown;
  std::vector<Objective> asked = objectives();
  if (!ranks.mean.empty()) asked.push_back(perceived);
  for (const Objective& objective : asked) {
    page.heading(objective.words);
    if (objective.by_people) add_words(page, ranks);
    files.figure(page, std::string("front-") + objective.key, front_figure(rows, objective),
                 objective.by_people
                     ? "What the study showed; dashed, what nothing beats."
                     : "Each technique's front over its parameters; dashed, what nothing beats.");
    if (!objective.by_people) add_needs(page, rows, objective);
    json front = json::array();
    std::vector<std::vector<Cell>> cells;
    for (const std::size_t index : front_rows(rows, objective.key)) {
      front.push_back(rows[index]);
      shown.insert(index);
      cells.push_back({settings_of(rows[index]),
                       {number_of(rows[index], "frame_ms"), 3},
                       {number_of(rows[index], "spread"), 3},
                       {number_of(rows[index], objective.key), objective.by_people ? 2 : 5}});
    }
    page.table("The front", {"technique and parameters", "frame ms", "spread", objective.key},
               cells);
    fronts[objective.key] = front;
  }
  page.heading("Pictures of the fronts");
  page.paragraph("The fastest first. A click on a picture shows it at its own size.");
  std::vector<std::size_t> order(shown.begin(), shown.end());
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return number_of(rows[a], "frame_ms") < number_of(rows[b], "frame_ms");
  });
  std::vector<Page::Picture> pictures;
  for (const std::size_t index : order)
    if (rows[index].contains("picture"))
      pictures.push_back({bytes_of(folder / rows[index].at("picture").get<std::string>()),
                          caption_of(rows[index])});
  page.pictures(pictures);
  page.heading("All runs");
  add_rows(page, rows);
  files.write("results.csv", results_csv(rows));
  files.write("report.html", page.text());
  return {{"files", files.names()}, {"fronts", fronts}};
}

namespace {

/// Share of wrong pixels over bias, a panel for each map size, a series for each strategy.
std::string bias_figure(const std::vector<json>& rows, const char* key, const char* words) {
  figures::Scatter chart;
  chart.frame.title = words;
  chart.frame.description = std::string(words) + " over bias, strategy and map size.";
  // Zero has no place on a logarithmic axis: it is drawn at the left end.
  constexpr double zero_at = 1e-4;
  chart.horizontal = {.title = "bias, m (0 stands at 0.0001)", .logarithmic = true};
  chart.vertical = {.title = words};
  std::vector<std::string> panels;
  for (const json& row : rows) {
    if (!is_done(row)) continue;
    const json& given = row.at("given");
    const std::string heading = row.at("technique").get<std::string>() + ", map of " +
                                scenes::json_text(given.at("map_size"));
    const std::string strategy = given.at("bias_strategy");
    auto panel = std::find(panels.begin(), panels.end(), heading);
    if (panel == panels.end()) {
      panels.push_back(heading);
      chart.panels.emplace_back().label = heading;
      panel = panels.end() - 1;
    }
    auto series = std::find(chart.series.begin(), chart.series.end(), strategy);
    if (series == chart.series.end()) {
      chart.series.push_back(strategy);
      series = chart.series.end() - 1;
    }
    chart.panels[static_cast<std::size_t>(panel - panels.begin())].points.push_back(
        {std::max(zero_at, given.at("bias").get<double>()),
         number_of(row, key),
         static_cast<std::size_t>(series - chart.series.begin()),
         {}});
  }
  return figures::draw(chart);
}

}  // namespace

json write_bias_report(const std::filesystem::path& folder, const json& device,
                       const std::string& command, const std::vector<json>& rows) {
  Files files(folder);
  Page page("Error against bias");
  add_facts(page, device, command, rows);
  page.paragraph(
      "Pictures are judged against exact hard shadows of the lights' centres, traced at every "
      "pixel. Acne is false shadow: the share of judged pixels more than 0.1 darker than the "
      "truth. "
      "Detachment is missing shadow: the share more than 0.1 lighter. Jagged edges of a coarse map "
      "count in both, whatever the bias.");
  files.figure(page, "acne", bias_figure(rows, "false_shadow", "acne: share of false shadow"),
               "Acne falls with bias.");
  files.figure(page, "detachment",
               bias_figure(rows, "missing_shadow", "detachment: share of missing shadow"),
               "Detachment rises with bias.");
  std::vector<std::vector<Cell>> cells;
  for (const json& row : rows) {
    if (!is_done(row)) continue;
    const json& given = row.at("given");
    cells.push_back({row.at("technique").get<std::string>(),
                     {given.at("map_size").get<double>(), 0},
                     given.at("bias_strategy").get<std::string>(),
                     {given.at("bias").get<double>(), 4},
                     {number_of(row, "false_shadow"), 5},
                     {number_of(row, "missing_shadow"), 5},
                     {number_of(row, "false_shadow") + number_of(row, "missing_shadow"), 5},
                     {number_of(row, "frame_ms"), 3}});
  }
  page.table("Acne and detachment",
             {"technique", "map", "strategy", "bias, m", "acne", "detachment", "sum", "frame ms"},
             cells);
  page.heading("All runs");
  add_rows(page, rows);
  files.write("results.csv", results_csv(rows));
  files.write("report.html", page.text());
  return {{"files", files.names()}, {"fronts", json::object()}};
}

}  // namespace penumbra::experiments
