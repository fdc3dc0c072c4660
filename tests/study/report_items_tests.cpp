// What the report says beside the tests of report_tests.cpp: the analysis of 2007, what fixes its
// numbers, warnings, raters, objective measures, and answers to degenerate input.
#include <gmock/gmock.h>

#include <cmath>

#include "study/random.h"
#include "study/simulate.h"
#include "study/statistics/report.h"
#include "study_file.h"
#include "survey_rows.h"

namespace penumbra::study {
namespace report_items_tests {

using nlohmann::json;
using ::testing::HasSubstr;

const json& entry(const json& list, const char* key, const std::string& value) {
  return *std::find_if(list.begin(), list.end(),
                       [&](const json& item) { return item[key] == value; });
}

/// Three people type digits that are no ranks; the last one means 9 as best.
std::vector<ResponseRow> typed_digits() {
  std::vector<ResponseRow> rows;
  const int digits[4][3] = {{1, 5, 9}, {2, 5, 8}, {1, 4, 9}, {9, 5, 1}};
  for (std::size_t person = 0; person < 4; ++person) {
    for (int i = 0; i < 3; ++i) {
      const int digit = digits[person][i];
      rows.push_back(row_of(person_name(person), "car", std::string(1, static_cast<char>('a' + i)),
                            digit, static_cast<int>(person) + 1));
      rows.back().digit = digit;
    }
  }
  return rows;
}

TEST(AnalysisOf2007, MeansWeightsAndOrderAreOfTheDigitsAsTyped) {
  const json sets = statistics_report(typed_digits(), {})["included_sets"];
  const json& all = sets["all"]["scenes"][0];
  EXPECT_EQ(all["ranks_of"], "digits");
  const json& a = entry(all["techniques"], "technique", "a");
  EXPECT_DOUBLE_EQ(a["mean_rank"].get<double>(), (1 + 2 + 1 + 9) / 4.0);
  EXPECT_DOUBLE_EQ(a["weighted_mean_rank"].get<double>(), (1 * 1 + 2 * 2 + 3 * 1 + 4 * 9) / 10.0);
  EXPECT_DOUBLE_EQ(a["mean_mid_rank"].get<double>(), (1 + 1 + 1 + 3) / 4.0);
  double sum = 0.0;
  for (const json& row : all["techniques"]) sum += row["weighted_mean_rank"].get<double>();
  EXPECT_NEAR(sum, (1 * 15 + 2 * 15 + 3 * 14 + 4 * 15) / 10.0, 1e-12) << "mid-ranks would give 6";
  // b is 5.0, 4.7 and 5.6 by weight: the order is by the digits' weighted means.
  EXPECT_EQ(all["techniques"][0]["technique"], "a");
  EXPECT_EQ(all["techniques"][1]["technique"], "b");
  EXPECT_EQ(all["techniques"][2]["technique"], "c");
}

TEST(AnalysisOf2007, DigitsOnSomePagesOnlyLeaveMidRanks) {
  auto rows = typed_digits();
  rows.back().digit.reset();
  const json all = statistics_report(rows, {})["included_sets"]["all"]["scenes"][0];
  EXPECT_EQ(all["ranks_of"], "mid_ranks");
  EXPECT_DOUBLE_EQ(entry(all["techniques"], "technique", "a")["mean_rank"].get<double>(), 1.5);
}

/// Two pages with the same answers double the rows and halve the errors' square, less a degree of
/// freedom: t grows by sqrt(9 * 10 / (4 * 5 * 2)) = 1.5 for five people, without one more of them.
TEST(AnalysisOf2007, PagesTakenForPeopleAreLabelledUnsoundBesideTheSoundTest) {
  std::vector<ResponseRow> rows;
  const double places[5][3] = {{1, 2, 3}, {1, 3, 2}, {2, 1, 3}, {1, 2, 3}, {1, 2, 3}};
  for (std::size_t person = 0; person < 5; ++person) {
    for (const char* scene : {"car", "boxes"}) {
      for (int i = 0; i < 3; ++i) {
        rows.push_back(row_of(person_name(person), scene,
                              std::string(1, static_cast<char>('a' + i)), places[person][i]));
      }
    }
  }
  ReportOptions options;
  const json report = statistics_report(rows, options);
  const json& overall = report["included_sets"]["all"]["overall"];
  const json& twin = overall["pooled_rows"];
  EXPECT_EQ(twin["unsound"], true);
  EXPECT_EQ(twin["rows"], 10);
  EXPECT_EQ(overall["participants"], 5);
  EXPECT_EQ(twin["paired_t"][0]["df"], 9);
  EXPECT_EQ(overall["paired_t"][0]["df"], 4);
  EXPECT_NEAR(twin["paired_t"][0]["t"].get<double>(),
              1.5 * overall["paired_t"][0]["t"].get<double>(), 1e-12);
  const std::string table = statistics_table(report, options);
  EXPECT_THAT(table, HasSubstr("all scenes, 10 pages taken for people (unsound"));
}

TEST(ReportItems, PeopleWhoStoppedEarlyAreCountedApart) {
  std::vector<ResponseRow> rows;
  for (std::size_t person = 0; person < 4; ++person) {
    for (const char* scene : {"car", "boxes"}) {
      if (person == 3 && scene[0] == 'b') continue;
      for (int i = 0; i < 2; ++i) {
        rows.push_back(
            row_of(person_name(person), scene, std::string(1, static_cast<char>('a' + i)), 1 + i));
        rows.back().included = person != 0;
      }
    }
  }
  const json counts = statistics_report(rows, {})["counts"];
  EXPECT_EQ(counts["entered"], 4);
  EXPECT_EQ(counts["taken_out"], 1);
  EXPECT_EQ(counts["completed"], 2);
  EXPECT_EQ(counts["stopped_early"], 1);
}

TEST(ReportItems, GroupsThatWereNeverComparedAreSaidToBeNotConnected) {
  // As a CSV of two studies in one: some ranked a and b, others c and d.
  std::vector<ResponseRow> rows;
  for (std::size_t i = 0; i < 8; ++i) {
    const bool swap = i == 2 || i == 6;
    rows.push_back(row_of(person_name(i), "s", i < 4 ? "a" : "c", swap ? 2 : 1));
    rows.push_back(row_of(person_name(i), "s", i < 4 ? "b" : "d", swap ? 1 : 2));
  }
  const json report = statistics_report(rows, {});
  const json& worths = report["included_sets"]["all"]["overall"]["plackett_luce"];
  EXPECT_THAT(worths["reason"].get<std::string>(), HasSubstr("not connected"));
  EXPECT_EQ(worths["groups"], json::parse(R"([["a", "b"], ["c", "d"]])"));
  EXPECT_THAT(worths["regularised"]["reason"].get<std::string>(), HasSubstr("not connected"));
  EXPECT_THAT(report["warnings"].dump(), HasSubstr("not connected"));
}

TEST(ReportItems, ATechniqueThatAlwaysWinsHasARegularisedWorth) {
  std::vector<ResponseRow> rows;
  for (std::size_t i = 0; i < 6; ++i) {
    rows.push_back(row_of(person_name(i), "s", "best", 1));
    rows.push_back(row_of(person_name(i), "s", "b", i % 2 == 0 ? 2 : 3));
    rows.push_back(row_of(person_name(i), "s", "c", i % 2 == 0 ? 3 : 2));
  }
  const json worths =
      statistics_report(rows, {})["included_sets"]["all"]["overall"]["plackett_luce"];
  EXPECT_THAT(worths["reason"].get<std::string>(), HasSubstr("unbounded"));
  const json& list = worths["regularised"]["worths"];
  EXPECT_GT(entry(list, "technique", "best")["log_worth"].get<double>(), 1.0);
  EXPECT_NEAR(entry(list, "technique", "b")["log_worth"].get<double>(),
              entry(list, "technique", "c")["log_worth"].get<double>(), 1e-9);
}

TEST(ReportItems, RanksThatFollowTheScreenAreFlagged) {
  std::vector<ResponseRow> rows;
  Random random(3);
  for (std::size_t person = 0; person < 12; ++person) {
    for (int scene = 0; scene < 6; ++scene) {
      const auto slots = random.permutation(9);
      for (std::size_t i = 0; i < 9; ++i) {
        const double rank = person == 0 ? static_cast<double>(slots[i]) : static_cast<double>(i);
        rows.push_back(row_of(person_name(person), "scene" + std::to_string(scene),
                              std::string(1, static_cast<char>('a' + i)), 1.0 + rank));
        rows.back().slot = static_cast<int>(slots[i]);
      }
    }
  }
  const json report = statistics_report(rows, {});
  std::vector<std::string> found;
  for (const json& flag : report["flags"]) {
    if (flag["flag"] == "positional") found.push_back(flag["participant"]);
  }
  EXPECT_EQ(found, std::vector<std::string>{person_name(0)});
  EXPECT_DOUBLE_EQ(report["raters"][0]["positional_rho"].get<double>(), 1.0);
}

TEST(ReportItems, ObjectiveMeasuresAreHeldAgainstRanksPerSceneAndPooledWithinScenes) {
  std::vector<ResponseRow> rows;
  for (std::size_t person = 0; person < 3; ++person) {
    for (const char* scene : {"car", "boxes"}) {
      for (int i = 0; i < 3; ++i) {
        rows.push_back(
            row_of(person_name(person), scene, std::string(1, static_cast<char>('a' + i)), 1 + i));
      }
    }
  }
  ReportOptions options;
  // Errors rise with the ranks in one scene and fall in the other, which is ten times as dark;
  // means over scenes would follow the first alone.
  options.measures = parse_measures(
      "scene,technique,rms_y,frame_ms_median\n"
      "car,a,10,3\ncar,b,20,2\ncar,c,30,4\nboxes,a,3,\nboxes,b,2,\nboxes,c,1,\n");
  const json objective = statistics_report(rows, options)["included_sets"]["all"]["objective"];
  const json& rms = objective["measures"]["rms_y"];
  EXPECT_DOUBLE_EQ(entry(rms["scenes"], "scene", "car")["spearman"].get<double>(), 1.0);
  EXPECT_DOUBLE_EQ(entry(rms["scenes"], "scene", "boxes")["kendall_tau_b"].get<double>(), -1.0);
  EXPECT_DOUBLE_EQ(rms["pooled_within_scenes"]["spearman"].get<double>(), 0.0);
  EXPECT_EQ(rms["pooled_within_scenes"]["n"], 6);
  // c is slower and worse than both; a is better, b faster.
  std::vector<std::string> front;
  for (const json& point : objective["pareto"][0]["front"]) front.push_back(point["technique"]);
  EXPECT_EQ(front, (std::vector<std::string>{"a", "b"}));
}

TEST(ReportItems, TheDigestIsOfTheAnswersWhateverTheirOrder) {
  auto rows = typed_digits();
  const json before = statistics_report(rows, {})["data_sha256"];
  std::reverse(rows.begin(), rows.end());
  EXPECT_EQ(statistics_report(rows, {})["data_sha256"], before);
  rows.front().digit = 2;
  EXPECT_NE(statistics_report(rows, {})["data_sha256"], before);
}

/// Fails for numbers that are none, and for results that are missing without a reason beside them.
void expect_answers(const json& value, const std::string& path) {
  if (value.is_number_float()) {
    EXPECT_TRUE(std::isfinite(value.get<double>())) << path;
  }
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      expect_answers(value[i], path + "/" + std::to_string(i));
    }
  }
  if (!value.is_object()) return;
  for (const char* key :
       {"p_value", "f_p_value", "chi_square", "statistic", "f", "t", "statistic_v", "mean_rank",
        "weighted_mean_rank", "sd", "log_likelihood", "spearman"}) {
    if (value.contains(key) && value[key].is_null()) {
      EXPECT_FALSE(value.value("reason", "").empty()) << path << "/" << key;
    }
  }
  for (const auto& [key, item] : value.items()) expect_answers(item, path + "/" + key);
}

/// A survey of up to four people, three scenes and four pictures, most of it missing or tied.
std::vector<ResponseRow> random_survey(Random& random) {
  std::vector<ResponseRow> rows;
  const std::size_t people = random.below(5);
  const std::size_t pictures = 1 + random.below(4);
  const std::size_t steps = 1 + random.below(3);  // one step: all tied
  const bool digits = random.below(2) == 0;
  for (std::size_t person = 0; person < people; ++person) {
    for (std::size_t scene = 0; scene < 3; ++scene) {
      if (random.below(3) == 0) continue;
      const int difficulty = static_cast<int>(random.below(6));
      for (std::size_t i = 0; i < pictures; ++i) {
        if (random.below(4) == 0) continue;
        const int rank = 1 + static_cast<int>(random.below(steps));
        rows.push_back(row_of(person_name(person), "scene" + std::to_string(scene),
                              std::string(1, static_cast<char>('a' + i)), rank,
                              difficulty > 0 ? std::optional<int>(difficulty) : std::nullopt));
        if (digits) rows.back().digit = rank;
        if (random.below(6) == 0) rows.back().weight = 0.0;
        rows.back().slot = static_cast<int>(i);
      }
    }
  }
  return rows;
}

TEST(ReportItems, WhateverIsMissingOrTiedIsAnsweredWithAReason) {
  Random random(77);
  ReportOptions options;
  options.resampling.resamples = 20;
  options.resampling.permutations = 19;
  options.measures =
      parse_measures("scene,technique,rms_y,frame_ms_median\nscene0,a,1,2\nscene0,b,1,1\n");
  for (int i = 0; i < 150; ++i) {
    const auto rows = random_survey(random);
    const json report = statistics_report(rows, options);
    expect_answers(report, "survey " + std::to_string(i));
    EXPECT_FALSE(statistics_table(report, options).empty());
    if (::testing::Test::HasFailure()) break;
  }
}

}  // namespace report_items_tests
}  // namespace penumbra::study
