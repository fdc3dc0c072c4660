#include "experiments/sweep/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "experiments/report/rows.h"
#include "experiments/sweep/grid.h"
#include "experiments/sweep/limits.h"
#include "figures/charts.h"
#include "renderer/frame/cost_report.h"

namespace penumbra::experiments {
namespace {

using nlohmann::json;

constexpr std::array<int, 2> table_triangles{swept_triangles[0], swept_triangles[1]};

/// In the order of the rows.
std::vector<std::string> names_of(const std::vector<json>& rows) {
  std::vector<std::string> names;
  for (const json& row : rows) {
    const std::string name = row.at("name");
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

/// Frame time over size, a series for each number of objects, a panel for each triangle count: the
/// surfaces of figures 4.2 to 4.14 as curves.
std::string times_figure(const std::vector<json>& rows, const std::string& name) {
  figures::Scatter chart;
  chart.frame.title = "Frame times of " + name;
  chart.frame.description = "Milliseconds of a frame over the picture's edge in pixels under " +
                            std::to_string(swept_lights) + " lights, by number of objects.";
  chart.horizontal = {.title = "edge of the picture, pixels", .logarithmic = true};
  chart.vertical = {.title = "frame, ms", .logarithmic = true};
  std::map<int, std::size_t> series;
  std::vector<TimeGrid> grids;
  std::set<int> triangles;
  for (const json& row : rows)
    if (const auto scene = read_sweep_scene(row.at("scene").get<std::string>()))
      triangles.insert(scene->triangles);
  for (const int count : triangles) {
    grids.push_back(time_grid(rows, name, count, swept_lights));
    for (const auto& point : grids.back().points) series.try_emplace(point.objects, 0);
  }
  if (series.empty()) return {};
  for (auto& [objects, index] : series) {
    index = chart.series.size();
    chart.series.push_back(std::to_string(objects) + (objects == 1 ? " object" : " objects"));
  }
  std::size_t at = 0;
  for (const int count : triangles) {
    auto& panel = chart.panels.emplace_back();
    panel.label = std::to_string(count) + " triangles an object";
    for (const auto& point : grids[at++].points)
      panel.points.push_back({point.pixels, point.ms, series.at(point.objects), {}});
  }
  return figures::draw(chart);
}

/// Median of the ratios to `none` with the quartiles, a row for each technique.
std::string ratios_figure(const std::vector<json>& rows) {
  figures::DotPlot plot;
  plot.frame.title = "Cost over none";
  plot.frame.description =
      "Median and quartiles over all scenes and sizes of a frame's time over that of none.";
  plot.axis = "times the frame without shadows: median and quartiles over scenes and sizes";
  plot.reference = 1.0;
  for (const std::string& name : names_of(rows)) {
    std::vector<double> ratios;
    for (const json& row : rows)
      if (row.at("name") == name && std::isfinite(number_of(row, "over_none")))
        ratios.push_back(number_of(row, "over_none"));
    auto& line = plot.rows.emplace_back();
    line.label = name;
    if (ratios.empty()) continue;
    line.value = quantile(ratios, 0.5);
    line.interval = {quantile(ratios, 0.25), quantile(ratios, 0.75)};
  }
  return figures::draw(plot);
}

std::string whole(double value) {
  return std::to_string(std::lround(value));
}

std::string objects_text(const std::optional<double>& objects) {
  return objects ? whole(*objects) : std::string("all");
}

void add_limits(Page& page, const std::vector<json>& rows, bool gpu) {
  const auto limits = limit_rows(rows);
  if (limits.empty()) return;
  page.heading("Objects at 20 frames a second");
  page.paragraph(
      "As table 4.1 of van Sambeek (2007): three lights, 50 ms a frame. Limit 1 is the most "
      "objects "
      "that stay under it at any size, with the largest size where they do; limit 2 the objects at "
      "the largest size measured, linear between measured counts. “All” and “or more” say that "
      "every "
      "count measured was fast enough.");
  std::vector<std::vector<Cell>> cells;
  for (const LimitRow& row : limits)
    cells.push_back({row.label, row.technique, row.limit1[0], row.limit2[0], row.limit1[1],
                     row.limit2[1], row.growth, row.bottleneck, row.published});
  page.table("Table 4.1 today",
             {"2007", "technique", "low poly, limit 1", "low poly, limit 2", "high poly, limit 1",
              "high poly, limit 2", "time grows as", "bottleneck",
              "published: low, high limit 2 at 1200 x 1200, bottleneck"},
             cells);
  page.paragraph(
      "The bottleneck is judged from how the time grows: “fill rate” where more than 8 fragments a "
      "pixel are drawn beyond those of none, “geometry” where time grows with objects and its "
      "exponent over pixels is below 0.25, otherwise “shaders”.");
  for (std::size_t poly = 0; poly < table_triangles.size(); ++poly) {
    std::vector<double> ours, theirs;
    for (const LimitRow& row : limits)
      for (const PublishedLimit& published : table_4_1())
        if (published.technique == row.technique && row.technique != limits.front().technique) {
          ours.push_back(row.objects[poly]);
          theirs.push_back(published.objects[poly].value_or(1e9));
        }
    const Agreement order = agreement(ours, theirs);
    page.paragraph(std::to_string(table_triangles[poly]) +
                   " triangles: of the pairs of techniques whose limit 2 both tables tell apart, " +
                   std::to_string(order.agreeing) + " of " + std::to_string(order.pairs) +
                   " stand in the published order." +
                   (gpu ? "" : " This device is a processor: reported, not judged."));
  }
}

}  // namespace

std::vector<LimitRow> limit_rows(const std::vector<json>& rows) {
  std::vector<LimitRow> result;
  std::optional<Growth> none;
  for (const PublishedLimit& published : table_4_1()) {
    LimitRow row{published.label, published.technique, "", {}, {}, {}, "–", "–"};
    bool any = false;
    for (const int triangles : table_triangles) {
      const auto limits = limits_of(time_grid(rows, published.technique, triangles, swept_lights));
      any = any || limits;
      row.limit1.push_back(!limits ? "–"
                           : limits->objects == 0
                               ? "none"
                               : std::to_string(limits->objects) + " at " + whole(limits->size));
      row.limit2.push_back(!limits ? "–"
                                   : whole(limits->at_largest) +
                                         (limits->beyond ? " or more at " : " at ") +
                                         whole(limits->largest));
      row.objects.push_back(limits ? limits->at_largest : 0.0);
    }
    if (!any) continue;
    if (const auto growth =
            growth_of(time_grid(rows, published.technique, table_triangles[1], swept_lights))) {
      if (!none) none = growth;  // the table's first row
      char text[96];
      std::snprintf(text, sizeof text, "pixels^%.2f, objects^%.2f, %.1f fragments a pixel",
                    growth->over_pixels, growth->over_objects, growth->fragments_per_pixel);
      row.growth = text;
      row.bottleneck = bottleneck_of(*growth, *none);
    }
    row.published = objects_text(published.objects[0]) + ", " + objects_text(published.objects[1]) +
                    ", " + published.bottleneck;
    result.push_back(row);
  }
  return result;
}

std::vector<std::string> write_sweep_report(const std::filesystem::path& folder, const json& device,
                                            const std::string& command,
                                            const std::vector<json>& rows) {
  std::filesystem::create_directories(folder / "figures");
  std::vector<std::string> files{"results.csv", "report.html"};
  const auto write = [&](const std::string& name, const std::string& bytes) {
    write_report_file(folder / name, bytes);
    if (name.starts_with("figures/")) files.push_back(name);
  };
  Page page("Costs of shadow techniques");
  add_facts(page, device, command, rows);
  add_limits(page, rows, device.at("type") != "cpu");
  page.heading("Costs beside no shadows");
  const std::string ratios = ratios_figure(rows);
  write("figures/over-none.svg", ratios);
  page.figure(ratios, "A frame's time over that of the same view without shadows.");
  page.heading("Frame times");
  for (const std::string& name : names_of(rows)) {
    const std::string svg = times_figure(rows, name);
    if (svg.empty()) continue;
    write("figures/times-" + file_name(name) + ".svg", svg);
    page.figure(svg, name + ": milliseconds of a frame under three lights. Real time is 50 ms.");
  }
  page.heading("All runs");
  add_rows(page, rows);
  write("results.csv", results_csv(rows));
  write("report.html", page.text());
  return files;
}

}  // namespace penumbra::experiments
