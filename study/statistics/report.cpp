#include "study/statistics/report.h"

#include <algorithm>
#include <iomanip>
#include <set>
#include <sstream>

#include "study/statistics/analysis.h"
#include "study/statistics/arms.h"
#include "study/statistics/histograms.h"
#include "study/statistics/jod.h"
#include "study/statistics/provenance.h"
#include "study/statistics/raters.h"
#include "study/statistics/screening.h"
#include "study/statistics/survey_data.h"
#include "study/statistics/worths.h"

namespace penumbra::study {

namespace {

using nlohmann::json;
using statistics::Flag;
using statistics::Selection;
using statistics::SurveyData;

json flags_json(const SurveyData& data, const std::vector<Flag>& flags) {
  json list = json::array();
  for (const Flag& flag : flags)
    list.push_back(flag_json(
        {data.participants[flag.participant], flag.name, flag.value, flag.threshold, flag.reason}));
  return list;
}

/// The ranks' flags, then the given ones of people who have ranks.
std::vector<Flag> all_flags(const SurveyData& data, const ReportOptions& options) {
  auto flags = statistics::screen(data, options.plan.screening);
  for (const GivenFlag& given : options.given_flags) {
    const auto& names = data.participants;
    const auto found = std::lower_bound(names.begin(), names.end(), given.participant);
    if (found == names.end() || *found != given.participant) continue;
    flags.push_back({static_cast<std::size_t>(found - names.begin()),
                     given.name,
                     given.value,
                     given.threshold,
                     given.reason,
                     {}});
  }
  std::stable_sort(flags.begin(), flags.end(),
                   [](const Flag& a, const Flag& b) { return a.participant < b.participant; });
  return flags;
}

Selection everything(const SurveyData& data) {
  return {std::vector<bool>(data.pages.size(), true), std::vector<bool>(data.pages.size(), false)};
}

Selection without_flagged(const SurveyData& data, const std::vector<Flag>& flags) {
  Selection selection = everything(data);
  std::set<std::size_t> flagged;
  for (const Flag& flag : flags) flagged.insert(flag.participant);
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    selection.used[i] = !flagged.contains(data.pages[i].participant);
  }
  return selection;
}

Selection inverted_turned(const SurveyData& data, const std::vector<Flag>& flags) {
  Selection selection = everything(data);
  for (const Flag& flag : flags) {
    if (flag.page) selection.turned[*flag.page] = true;
    if (flag.name != "inverted") continue;
    for (std::size_t i = 0; i < data.pages.size(); ++i) {
      if (data.pages[i].participant == flag.participant) selection.turned[i] = true;
    }
  }
  return selection;
}

json analyse_part(const SurveyData& data, const Selection& selection,
                  std::optional<std::size_t> scene, const statistics::AnalysisSettings& settings) {
  const auto table = participant_table(data, selection, scene);
  json part = statistics::analyse(data, table, settings);
  statistics::add_histograms(part, data, selection, scene);
  part["critical_difference"] = statistics::critical_difference(data, table, settings.alpha);
  std::vector<std::string> techniques;
  for (const json& row : part["techniques"]) techniques.push_back(row["technique"]);
  const auto rankings = statistics::rankings_of(data, selection, scene, techniques);
  part["plackett_luce"] = statistics::worths_json(rankings, techniques);
  part["jod"] = statistics::jod_json(rankings, techniques);
  return part;
}

/// "All results of all surveys" as one sample, as in table 4.9 of van Sambeek 2007.
json pooled_rows(const SurveyData& data, const Selection& selection, double alpha) {
  json twin = statistics::analyse_as_in_2007(
      data, participant_table(data, selection, std::nullopt, statistics::Blocks::pages), alpha);
  twin["unsound"] = true;
  twin["reason"] =
      "every page counts as a participant of its own, so that tests reject too often; it stands "
      "here "
      "to be held against table 4.9 of van Sambeek 2007";
  return twin;
}

json analyse_set(const SurveyData& data, const Selection& selection, const ReportOptions& options) {
  const statistics::AnalysisSettings settings{options.plan.alpha, options.resampling};
  json scenes = json::array();
  for (std::size_t scene = 0; scene < data.scenes.size(); ++scene) {
    json part = analyse_part(data, selection, scene, settings);
    part["scene"] = data.scenes[scene];
    scenes.push_back(std::move(part));
  }
  json set = {{"scenes", scenes},
              {"overall", analyse_part(data, selection, std::nullopt, settings)}};
  set["overall"]["pooled_rows"] = pooled_rows(data, selection, options.plan.alpha);
  if (!options.measures.empty()) set["objective"] = objective_json(set, options.measures);
  return set;
}

/// Text in a column of `width` characters, counted as UTF-8 code points.
std::string padded(const std::string& text, std::size_t width) {
  const auto length = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
  return text + std::string(length < width ? width - length : 1, ' ');
}

std::string two_decimals(const json& value) {
  if (value.is_null()) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << value.get<double>();
  return text.str();
}

std::string one_table(const json& part, const std::string& title, const ReportOptions& options) {
  constexpr std::size_t cell = 7;
  std::size_t name_width = 12;
  const auto label = [&](const std::string& id) {
    const auto found = options.labels.find(id);
    return found == options.labels.end() ? id : found->second;
  };
  for (const json& row : part["techniques"]) {
    name_width = std::max(name_width, label(row["technique"]).size() + 2);
  }
  std::ostringstream text;
  text << title << "\n"
       << padded("", name_width) << "subset for alpha = " << options.plan.alpha << "\n"
       << padded("technique", name_width);
  for (std::size_t i = 1; i <= part["subsets"].size(); ++i) text << padded(std::to_string(i), cell);
  text << "\n";
  for (const json& row : part["techniques"]) {
    std::string line = padded(label(row["technique"]), name_width);
    for (const json& subset : part["subsets"]) {
      const bool member = std::find(subset.begin(), subset.end(), row["technique"]) != subset.end();
      line += padded(member ? two_decimals(row["weighted_mean_rank"]) : "", cell);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text << line << "\n";
  }
  return text.str();
}

std::string titled(const std::string& name, const json& part) {
  return name + " (" + part["participants"].dump() + " participants)";
}

}  // namespace

ReportOptions report_options(const Study& study) {
  ReportOptions options;
  options.plan = study.analysis;
  options.study_id = study.id;
  options.study_hash = study_hash(study);
  for (const Page& page : study.pages) {
    for (const Picture& picture : page.pictures) options.labels[picture.id] = picture.label;
  }
  return options;
}

json statistics_report(const std::vector<ResponseRow>& rows, const ReportOptions& options) {
  return survey_report(statistics::gather(rows), options);
}

json survey_report(const SurveyData& data, const ReportOptions& options) {
  const auto flags = all_flags(data, options);
  json report = {{"participants", data.participants.size()},
                 {"pages", data.pages.size()},
                 {"counts", statistics::counts_json(data, flags)},
                 {"included_sets",
                  {{"all", analyse_set(data, everything(data), options)},
                   {"without_flagged", analyse_set(data, without_flagged(data, flags), options)},
                   {"inverted_turned", analyse_set(data, inverted_turned(data, flags), options)}}},
                 {"flags", flags_json(data, flags)},
                 {"raters", statistics::raters_json(data)},
                 {"methods", statistics::methods_json(options)},
                 {"data_sha256", statistics::data_digest(data)},
                 {"notes", statistics::notes_json(data)}};
  if (auto arms = statistics::arms_json(data, flags); !arms.is_null())
    report["arms"] = std::move(arms);
  report["warnings"] = statistics::warnings_json(report);
  if (!options.study_id.empty()) report["study"] = options.study_id;
  if (!options.study_hash.empty()) report["study_hash"] = options.study_hash;
  return report;
}

std::string statistics_table(const json& report, const ReportOptions& options,
                             const std::string& set) {
  const json& part = report.at("included_sets").at(set);
  std::string text;
  for (const json& scene : part["scenes"]) {
    text += one_table(scene, titled(scene["scene"], scene), options) + "\n";
  }
  const json& twin = part["overall"]["pooled_rows"];
  return text + one_table(part["overall"], titled("all scenes", part["overall"]), options) + "\n" +
         one_table(twin,
                   "all scenes, " + twin["rows"].dump() +
                       " pages taken for people (unsound: for comparison with 2007 only)",
                   options);
}

json survey_flags(const SurveyData& data, const ReportOptions& options) {
  return flags_json(data, all_flags(data, options));
}

json screening_flags(const SurveyData& data, const Screening& screening) {
  return flags_json(data, statistics::screen(data, screening));
}

json flag_json(const GivenFlag& flag) {
  return {{"participant", flag.participant},
          {"flag", flag.name},
          {"value", flag.value},
          {"threshold", flag.threshold},
          {"reason", flag.reason}};
}

}  // namespace penumbra::study
