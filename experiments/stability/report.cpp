#include "experiments/stability/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "experiments/report/page.h"
#include "experiments/stability/safe_ranges.h"
#include "figures/charts.h"
#include "renderer/error.h"
#include "techniques/registry.h"

namespace penumbra::experiments::stability {
namespace {

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

std::string optional_digits(const std::optional<double>& value) {
  return value ? digits(*value) : std::string();
}

std::string steps_csv(const Report& report) {
  std::string text = csv_line({"technique", "axis", "value", "state", "visibility_rms", "judged",
                               "shadowed", "false_shadow", "missing_shadow", "lit", "dark",
                               "non_finite", "code", "field", "message", "seconds"});
  for (const Finding& finding : report.findings)
    for (const Step& step : finding.steps) {
      const Verdict& v = step.verdict;
      text +=
          csv_line({finding.technique, finding.axis, digits(step.value), to_json(step).at("state"),
                    digits(v.visibility_rms), std::to_string(v.judged), std::to_string(v.shadowed),
                    digits(v.false_shadow), digits(v.missing_shadow), std::to_string(v.lit),
                    std::to_string(v.dark), std::to_string(v.non_finite), step.code, step.field,
                    step.message, digits(step.seconds)});
    }
  return text;
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.flush();
  if (!out) throw Error("unwritable", "cannot write " + file.string(), "out");
}

const Finding* find(const Report& report, const std::string& technique, const std::string& axis) {
  for (const Finding& finding : report.findings)
    if (finding.technique == technique && finding.axis == axis) return &finding;
  return nullptr;
}

/// A value short enough for a cell.
std::string short_text(const Axis& axis, double value) {
  if (!axis.has_between()) return axis.text(value);
  char number[32];
  std::snprintf(number, sizeof(number), "%.2g", value);
  return number;
}

/// What ends an axis; ! where it is refused.
std::string first_break(const Finding& finding, const Axis& axis) {
  if (!finding.ends) return "holds";
  return short_text(axis, *finding.ends) + (finding.refused ? "!" : "");
}

/// Scene axes against techniques: how far each goes.
std::string map_of_scene_axes(const Report& report) {
  figures::HeatMap map;
  map.frame = {.title = "How far each technique holds on every axis",
               .description =
                   "Rows are axes of scene, light and view, columns techniques. A cell "
                   "names the first value that breaks; light cells hold longer.",
               .width_mm = 260.0};
  map.low = "breaks at the first step";
  map.high = "holds to the last";
  for (const std::string& technique : report.techniques)
    map.columns.push_back(techniques::resolve(technique).label);
  for (const Axis& axis : scene_axes()) {
    figures::HeatMap::Row row{axis.title + (axis.unit.empty() ? "" : ", " + axis.unit), {}};
    bool any = false;
    for (const std::string& technique : report.techniques) {
      const Finding* finding = find(report, technique, axis.id);
      any |= finding != nullptr;
      if (finding == nullptr || !finding->holds) {
        row.cells.push_back({std::nullopt, finding == nullptr ? "" : "not served"});
        continue;
      }
      row.cells.push_back({share_held(*finding, axis), first_break(*finding, axis)});
    }
    if (any) map.rows.push_back(std::move(row));
  }
  return figures::draw(map);
}

/// One technique's errors over the steps of every axis.
std::string map_of_errors(const Report& report, const std::string& technique) {
  figures::HeatMap map;
  map.frame = {.title = "Errors of " + technique,
               .description =
                   "Rows are axes, columns their steps from gentle to absurd. A cell "
                   "holds the value; its shade is visibility_rms there.",
               .width_mm = 260.0};
  map.low = "visibility_rms 0.4 or no picture";
  map.high = "0";
  std::size_t most = 0;
  for (const Finding& finding : report.findings) {
    if (finding.technique != technique) continue;
    const Axis axis = find_axis(technique, finding.axis);
    figures::HeatMap::Row row{axis.title, {}};
    std::vector<Step> steps = finding.steps;
    const bool up = axis.values.back() >= axis.values.front();
    std::sort(steps.begin(), steps.end(), [&](const Step& a, const Step& b) {
      return up ? a.value < b.value : a.value > b.value;
    });
    for (const Step& step : steps) {
      const double rms = step.state == State::drawn && step.verdict.non_finite == 0
                             ? step.verdict.visibility_rms
                             : 1.0;
      row.cells.push_back({1.0 - std::min(1.0, rms / 0.4), short_text(axis, step.value)});
    }
    most = std::max(most, row.cells.size());
    map.rows.push_back(std::move(row));
  }
  for (std::size_t i = 0; i < most; ++i) map.columns.push_back(i == 0 ? "gentle" : "");
  return figures::draw(map);
}

/// A value with its unit.
Cell sorted_by(const std::string& text, double value) {
  Cell cell(text);
  cell.is_number = true;
  cell.number = value;
  return cell;
}

std::vector<Cell> cells_of(const Finding& finding) {
  const Axis axis = find_axis(finding.technique, finding.axis);
  const Reason* reason = finding.ends ? reason_of(finding.technique, finding.axis) : nullptr;
  const auto number = [&](const std::optional<double>& value) {
    return value ? sorted_by(axis.text(*value), *value) : Cell("");
  };
  const double gentle = finding.steps.front().verdict.visibility_rms;
  std::string verdict = "holds";
  if (finding.ends && finding.refused) verdict = finding.holds ? "refused" : "not served";
  if (finding.ends && !finding.refused)
    verdict = reason == nullptr ? "not explained" : reason->required ? "required" : "defect";
  return {{finding.technique},
          {axis.title},
          Cell(gentle, 4),
          number(finding.holds),
          number(finding.ends),
          {finding.cause},
          {finding.guard},
          {verdict},
          {reason == nullptr ? "" : reason->why}};
}

std::string html_of(const Report& report,
                    const std::vector<std::pair<std::string, std::string>>& figures) {
  Page page("Stability at the extremes");
  page.paragraph(
      "Every technique is pushed along every axis from gentle to absurd. The judge is exact rays "
      "in "
      "double precision on the processor, from the surface itself, over the scene as written; "
      "pixels "
      "that a move of their sample by 0.04 pixels changes are left out. A step is broken where "
      "visibility_rms is over twice that of the gentle step and over 0.02, where the light goes "
      "out "
      "on more than 2% of the lit pixels, where a pixel is no number, or where neither a picture "
      "nor "
      "an error that names what is at fault comes back. The first break is then narrowed by "
      "halving. "
      "Pictures are 96x96 (area lights 48x48), drawn in processes of their own, so that a crash or "
      "an endless step is a result like others.");
  page.facts({{"device", report.device},
              {"driver", report.driver},
              {"program", report.version},
              {"steps", std::to_string(report.steps)}});
  page.heading("How far each technique holds");
  for (const auto& [name, svg] : figures) {
    if (name == "errors") continue;
    page.figure(svg, name);
  }
  page.heading("Every technique on every axis");
  std::vector<std::vector<Cell>> rows;
  for (const Finding& finding : report.findings) rows.push_back(cells_of(finding));
  page.table("Findings",
             {"technique", "axis", "gentle rms", "holds to", "first that does not", "what happens",
              "what the program says", "verdict", "why"},
             rows);
  return page.text();
}

std::vector<SafeRange> ranges_of(const Report& report) {
  std::vector<SafeRange> ranges;
  for (const Finding& finding : report.findings) ranges.push_back(safe_range_of(finding));
  return ranges;
}

}  // namespace

Axis find_axis(const std::string& technique, const std::string& id) {
  for (const Axis& axis : scene_axes())
    if (axis.id == id) return axis;
  for (Axis& axis : parameter_axes(techniques::resolve(technique)))
    if (axis.id == id) return axis;
  throw std::logic_error("no axis " + id + " of " + technique);
}

double share_held(const Finding& finding, const Axis& axis) {
  if (!finding.ends) return 1.0;
  if (!finding.holds) return 0.0;
  const bool up = axis.values.back() >= axis.values.front();
  std::size_t held = 0;
  for (const double value : axis.values) held += up ? value < *finding.ends : value > *finding.ends;
  return static_cast<double>(held) / static_cast<double>(axis.values.size());
}

std::string findings_csv(const Report& report) {
  std::string text = csv_line(
      {"technique", "axis", "gentle_rms", "holds", "ends", "verdict", "cause", "guard", "why"});
  for (const Finding& finding : report.findings) {
    const auto cells = cells_of(finding);
    text += csv_line({finding.technique, finding.axis,
                      digits(finding.steps.front().verdict.visibility_rms),
                      optional_digits(finding.holds), optional_digits(finding.ends), cells[7].text,
                      finding.cause, finding.guard, cells[8].text});
  }
  return text;
}

void write_report(const Report& report, const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, std::string>> figures;
  figures.emplace_back("scene-axes", map_of_scene_axes(report));
  for (const std::string& technique : report.techniques)
    figures.emplace_back("errors-" + technique, map_of_errors(report, technique));
  std::error_code failed;
  std::filesystem::create_directories(folder / "figures", failed);
  for (const auto& [name, svg] : figures) write(folder / "figures" / (name + ".svg"), svg);
  write(folder / "results.csv", findings_csv(report));
  write(folder / "steps.csv", steps_csv(report));
  write(folder / "safe-ranges.md", safe_ranges_page(ranges_of(report)));
  write(folder / "report.html", html_of(report, figures));
}

}  // namespace penumbra::experiments::stability
