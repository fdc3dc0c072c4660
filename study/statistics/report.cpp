#include "study/statistics/report.h"

#include <algorithm>
#include <iomanip>
#include <set>
#include <sstream>

#include "study/statistics/analysis.h"
#include "study/statistics/histograms.h"
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
  for (const Flag& flag : flags) {
    list.push_back({{"participant", data.participants[flag.participant]},
                    {"flag", flag.name},
                    {"value", flag.value},
                    {"threshold", flag.threshold},
                    {"reason", flag.reason}});
  }
  return list;
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
                  std::optional<std::size_t> scene, double alpha) {
  const auto table = participant_table(data, selection, scene);
  json part = statistics::analyse(data, table, alpha);
  statistics::add_histograms(part, data, selection, scene);
  part["critical_difference"] = statistics::critical_difference(data, table, alpha);
  std::vector<std::string> techniques;
  for (const json& row : part["techniques"]) techniques.push_back(row["technique"]);
  part["plackett_luce"] = statistics::worths_json(data, selection, scene, techniques);
  return part;
}

json analyse_set(const SurveyData& data, const Selection& selection, double alpha) {
  json scenes = json::array();
  for (std::size_t scene = 0; scene < data.scenes.size(); ++scene) {
    json part = analyse_part(data, selection, scene, alpha);
    part["scene"] = data.scenes[scene];
    scenes.push_back(std::move(part));
  }
  return {{"scenes", scenes}, {"overall", analyse_part(data, selection, std::nullopt, alpha)}};
}

json methods_json(const AnalysisPlan& plan) {
  return {
      {"alpha", plan.alpha},
      {"ranks", "mid-ranks among the pictures of a page"},
      {"blocks", "participants; the pooled part takes each participant's mean mid-ranks"},
      {"repeats", "measure reliability only"},
      {"weights", "difficulty 1 to 5; weighted mean sum(w r) / sum(w)"},
      {"order", "by weighted mean rank"},
      {"subsets", "maximal sets of techniques whose paired t does not differ, Bonferroni"},
      {"quade", "a page's spread is the number of steps told apart"},
      {"wilcoxon",
       "zeros dropped; exact below 50 differences without ties or zeros, else "
       "normal with tie and continuity correction"},
      {"sign",
       "ties dropped in p, half in probability_a_better and its Clopper-Pearson "
       "interval"},
      {"plackett_luce", "maximum likelihood with ties, every page a ranking; log worths sum to 0"},
      {"families", "all pairs of one table"}};
}

json notes_json(const SurveyData& data) {
  json notes = json::array();
  std::size_t weighted = 0;
  for (const auto& page : data.pages) weighted += page.weight ? 1 : 0;
  if (weighted == 0 && !data.pages.empty()) {
    notes.push_back("no page has a difficulty: every page weighs 1");
  } else if (weighted < data.pages.size()) {
    notes.push_back(std::to_string(data.pages.size() - weighted) +
                    " pages without a difficulty are left out of weighted means");
  }
  if (!data.taken_out.empty()) {
    notes.push_back(std::to_string(data.taken_out.size()) +
                    " participants were taken out by a researcher");
  }
  return notes;
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
  text << title << " (" << part["participants"] << " participants)\n"
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
  const SurveyData data = statistics::gather(rows);
  const auto flags = statistics::screen(data, options.plan.screening);
  const double alpha = options.plan.alpha;
  json report = {{"participants", data.participants.size()},
                 {"pages", data.pages.size()},
                 {"included_sets",
                  {{"all", analyse_set(data, everything(data), alpha)},
                   {"without_flagged", analyse_set(data, without_flagged(data, flags), alpha)},
                   {"inverted_turned", analyse_set(data, inverted_turned(data, flags), alpha)}}},
                 {"flags", flags_json(data, flags)},
                 {"methods", methods_json(options.plan)},
                 {"notes", notes_json(data)}};
  if (!options.study_id.empty()) report["study"] = options.study_id;
  if (!options.study_hash.empty()) report["study_hash"] = options.study_hash;
  return report;
}

std::string statistics_table(const json& report, const ReportOptions& options,
                             const std::string& set) {
  const json& part = report.at("included_sets").at(set);
  std::string text;
  for (const json& scene : part["scenes"]) {
    text += one_table(scene, scene["scene"].get<std::string>(), options) + "\n";
  }
  return text + one_table(part["overall"], "all scenes", options);
}

json screening_flags(const std::vector<ResponseRow>& rows, const Screening& screening) {
  const SurveyData data = statistics::gather(rows);
  return flags_json(data, statistics::screen(data, screening));
}

}  // namespace penumbra::study
