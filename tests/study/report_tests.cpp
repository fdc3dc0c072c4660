#include "study/statistics/report.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "golden.h"
#include "survey_rows.h"

namespace penumbra::study {
namespace report_tests {

using nlohmann::json;
using ::testing::HasSubstr;

/// Rows of the synthetic survey, with the places as they were given (1, 2, 2, 3).
std::vector<ResponseRow> survey_rows() {
  const json data = golden("survey_complete")["data"];
  std::vector<ResponseRow> rows;
  for (std::size_t i = 0; i < data["raters"].size(); ++i) {
    for (std::size_t j = 0; j < data["items"].size(); ++j) {
      rows.push_back(row_of(data["raters"][i], "scene", data["items"][j], data["position"][i][j],
                            data["difficulty"][i].get<int>()));
    }
  }
  return rows;
}

const json& entry(const json& list, const char* key, const std::string& value) {
  return *std::find_if(list.begin(), list.end(),
                       [&](const json& item) { return item[key] == value; });
}

const json& pair_entry(const json& list, const std::string& x, const std::string& y) {
  return *std::find_if(list.begin(), list.end(), [&](const json& item) {
    return (item["a"] == x && item["b"] == y) || (item["a"] == y && item["b"] == x);
  });
}

TEST(Report, TheSyntheticSurveyComesOutAsInREndToEnd) {
  const json expected = golden("survey_complete")["expected"];
  const json report = statistics_report(survey_rows(), {});
  EXPECT_EQ(report["participants"], 14);
  EXPECT_EQ(report["pages"], 14);
  const json& scene = report["included_sets"]["all"]["scenes"][0];
  EXPECT_EQ(scene["scene"], "scene");
  const std::string items = "ABCDEFGHI";
  for (std::size_t i = 0; i < items.size(); ++i) {
    const json& technique = entry(scene["techniques"], "technique", std::string(1, items[i]));
    expect_close(technique["mean_rank"], expected["mean_ranks"][i], 1e-9, "mean");
    expect_close(technique["weighted_mean_rank"], expected["weighted_mean_ranks"][i], 1e-9, "w");
    EXPECT_EQ(technique["n"], 14);
  }
  const json& omnibus = scene["friedman"];
  expect_close(omnibus["chi_square"], expected["friedman_chi2"], 1e-6, "chi2");
  expect_close(omnibus["f_p_value"], expected["iman_davenport_p"], 1e-6, "F's p");
  expect_close(scene["quade"]["f"], expected["quade_F"], 1e-6, "Quade");
  for (const json& row : expected["paired_t"]) {
    const auto name = row["pair"].get<std::string>();
    const json& found = pair_entry(scene["paired_t"], name.substr(0, 1), name.substr(2));
    expect_close(std::abs(found["t"].get<double>()), std::abs(row["t"].get<double>()), 1e-6, name);
    expect_close(found["p_bonferroni"], row["p_bonferroni"], 1e-6, name);
  }
  const json& fit = expected["pl_npseudo_0"];
  for (std::size_t i = 0; i < items.size(); ++i) {
    const json& worth =
        entry(scene["plackett_luce"]["worths"], "technique", std::string(1, items[i]));
    EXPECT_NEAR(worth["log_worth"].get<double>(), fit["log_worth_centered"][i].get<double>(), 1e-5);
    EXPECT_NEAR(worth["se"].get<double>(), fit["se_centered"][i].get<double>(), 1e-5);
    EXPECT_NEAR(worth["quasi_se"].get<double>(), fit["quasi_se"][i].get<double>(), 1e-4);
  }
  EXPECT_NEAR(scene["plackett_luce"]["log_likelihood"].get<double>(), fit["loglik"].get<double>(),
              1e-6);
  std::vector<std::vector<std::string>> subsets = scene["subsets"];
  for (auto& subset : subsets) std::sort(subset.begin(), subset.end());
  std::sort(subsets.begin(), subsets.end());
  EXPECT_EQ(subsets, (expected["paired_t_bonferroni_maximal_cliques"]
                          .get<std::vector<std::vector<std::string>>>()));
}

TEST(Report, TheReversedRaterIsFlaggedAndTurnedRound) {
  const json report = statistics_report(survey_rows(), {});
  std::vector<std::string> inverted;
  for (const json& flag : report["flags"]) {
    if (flag["flag"] == "inverted") inverted.push_back(flag["participant"]);
  }
  EXPECT_EQ(inverted, std::vector<std::string>{"P12"});
  const json& sets = report["included_sets"];
  EXPECT_EQ(sets["inverted_turned"]["overall"]["participants"], 14);
  EXPECT_GT(sets["inverted_turned"]["overall"]["friedman"]["kendalls_w"].get<double>(),
            sets["all"]["overall"]["friedman"]["kendalls_w"].get<double>());
  // Without P12 alone, from R: friedman.test on the other thirteen.
  std::vector<ResponseRow> others = survey_rows();
  std::erase_if(others, [](const ResponseRow& row) { return row.participant == "P12"; });
  const json without = statistics_report(others, {});
  const json expected = golden("survey_complete")["expected"]["excluding_P12"];
  const json& omnibus = without["included_sets"]["all"]["overall"]["friedman"];
  expect_close(omnibus["chi_square"], expected["friedman_chi2"], 1e-6, "chi2");
  expect_close(omnibus["kendalls_w"], expected["kendall_W"], 1e-6, "W");
}

TEST(Report, TheOrderOfRowsDoesNotMatter) {
  auto rows = survey_rows();
  const json report = statistics_report(rows, {});
  std::reverse(rows.begin(), rows.end());
  EXPECT_EQ(statistics_report(rows, {}), report);
}

TEST(Report, PooledResultsTakeEachParticipantOnce) {
  // Five people, two scenes with the same answers: pooling adds no participants, so that every test
  // must say what it says of one scene.
  std::vector<ResponseRow> rows;
  const double places[5][3] = {{1, 2, 3}, {1, 3, 2}, {2, 1, 3}, {1, 2, 3}, {1, 2, 3}};
  for (int person = 0; person < 5; ++person) {
    for (const char* scene : {"car", "boxes"}) {
      for (int i = 0; i < 3; ++i) {
        rows.push_back(row_of("P" + std::to_string(person), scene, std::string(1, 'a' + i),
                              places[person][i], 1 + person % 5));
      }
    }
  }
  const json all = statistics_report(rows, {})["included_sets"]["all"];
  EXPECT_EQ(all["overall"]["participants"], 5);
  EXPECT_EQ(all["overall"]["pages"], 10);
  for (const char* part : {"friedman", "paired_t", "wilcoxon", "sign", "nemenyi", "conover",
                           "skillings_mack", "subsets"}) {
    EXPECT_EQ(all["overall"][part], all["scenes"][0][part]) << part;
  }
  // R: friedman.test(matrix(c(1,1,2,1,1, 2,3,1,2,2, 3,2,3,3,3), 5)): chi-squared 6.4, p 0.04076
  EXPECT_NEAR(all["overall"]["friedman"]["chi_square"].get<double>(), 6.4, 1e-12);
  EXPECT_NEAR(all["overall"]["friedman"]["p_value"].get<double>(), 0.04076220397836621, 1e-12);
}

TEST(Report, RepeatedPagesMeasureReliabilityOnly) {
  auto rows = survey_rows();
  const json before = statistics_report(rows, {});
  for (int i = 0; i < 9; ++i) {
    ResponseRow row = row_of("P01", "scene", std::string(1, static_cast<char>('A' + i)), 9 - i);
    row.page_index = 1;
    row.repeat = 1;
    rows.push_back(row);
  }
  const json after = statistics_report(rows, {});
  EXPECT_EQ(after["included_sets"]["all"], before["included_sets"]["all"]);
  const json& flag = entry(after["flags"], "participant", "P01");
  EXPECT_EQ(flag["flag"], "unreliable");
}

TEST(Report, DigitsAsTypedFeedThePairedTestAndTurnRoundAsTenMinusDigit) {
  std::vector<ResponseRow> rows;
  const int digits[4][3] = {{1, 5, 9}, {2, 5, 8}, {1, 4, 9}, {9, 5, 1}};
  for (int person = 0; person < 4; ++person) {
    for (int i = 0; i < 3; ++i) {
      rows.push_back(
          row_of("P" + std::to_string(person), "car", std::string(1, 'a' + i), digits[person][i]));
      rows.back().digit = digits[person][i];
    }
  }
  ReportOptions options;
  const json sets = statistics_report(rows, options)["included_sets"];
  const json& all = sets["all"]["scenes"][0];
  EXPECT_EQ(all["paired_t_of"], "digits");
  // Means of c(1-5, 2-5, 1-4, 9-5) and, the last person turned round, c(1-5, 2-5, 1-4, 1-5).
  EXPECT_DOUBLE_EQ(std::abs(pair_entry(all["paired_t"], "a", "b")["mean_difference"].get<double>()),
                   1.5);
  const json& turned = sets["inverted_turned"]["scenes"][0];
  EXPECT_DOUBLE_EQ(
      std::abs(pair_entry(turned["paired_t"], "a", "b")["mean_difference"].get<double>()), 3.5);
}

TEST(Report, HastyAndIndifferentPeopleAreFlagged) {
  auto rows = survey_rows();
  for (ResponseRow& row : rows) {
    row.active_ms = row.participant == "P03"   ? 9 * 1900.0
                    : row.participant == "P04" ? 9 * 2500.0
                                               : 9 * 6000.0;
    if (row.participant == "P05") row.rank = 1.0;
  }
  const json flags = statistics_report(rows, {})["flags"];
  EXPECT_EQ(entry(flags, "participant", "P03")["flag"], "fast");
  EXPECT_DOUBLE_EQ(entry(flags, "participant", "P03")["value"].get<double>(), 1.9);
  EXPECT_EQ(entry(flags, "participant", "P04")["flag"], "fast") << "below half the median";
  EXPECT_EQ(entry(flags, "participant", "P05")["flag"], "flat");
}

TEST(Report, APersonTakenOutIsLeftOutOfEverySet) {
  auto rows = survey_rows();
  for (ResponseRow& row : rows) row.included = row.participant != "P12";
  const json report = statistics_report(rows, {});
  EXPECT_EQ(report["participants"], 13);
  expect_close(report["included_sets"]["all"]["overall"]["friedman"]["chi_square"],
               golden("survey_complete")["expected"]["excluding_P12"]["friedman_chi2"], 1e-6, "");
  EXPECT_THAT(report["notes"].dump(), HasSubstr("taken out"));
}

TEST(Report, TheTableShowsMeansInTheirSubsets) {
  std::vector<ResponseRow> rows;
  for (int person = 0; person < 12; ++person) {
    const double swap = person % 2 == 0 ? 0.0 : 1.0;
    rows.push_back(row_of("P" + std::to_string(person), "car", "soft", 1.0 + swap));
    rows.push_back(row_of("P" + std::to_string(person), "car", "softer", 2.0 - swap));
    rows.push_back(row_of("P" + std::to_string(person), "car", "hard", 3.0));
  }
  ReportOptions options;
  options.labels["hard"] = "SSM";
  const std::string table = statistics_table(statistics_report(rows, options), options);
  EXPECT_EQ(table.substr(0, table.find("\n\n")),
            "car (12 participants)\n"
            "            subset for alpha = 0.05\n"
            "technique   1      2      \n"
            "soft        1.50\n"
            "softer      1.50\n"
            "SSM                3.00");
}

class Degenerate : public ::testing::Test {
 protected:
  static json overall(const std::vector<ResponseRow>& rows) {
    return statistics_report(rows, {})["included_sets"]["all"]["overall"];
  }
};

TEST_F(Degenerate, NoPages) {
  const json report = statistics_report({}, {});
  EXPECT_EQ(report["participants"], 0);
  EXPECT_EQ(report["pages"], 0);
  const json& part = report["included_sets"]["all"]["overall"];
  EXPECT_EQ(part["reason"], "no pages");
  EXPECT_TRUE(part["techniques"].empty());
  EXPECT_TRUE(part["friedman"]["chi_square"].is_null());
  EXPECT_FALSE(part["friedman"]["reason"].get<std::string>().empty());
  EXPECT_TRUE(report["flags"].empty());
}

TEST_F(Degenerate, OneParticipant) {
  const json part = overall({row_of("P1", "car", "a", 1), row_of("P1", "car", "b", 2)});
  EXPECT_TRUE(part["techniques"][0]["sd"].is_null());
  EXPECT_TRUE(part["techniques"][0]["ci95"].is_null());
  EXPECT_EQ(part["techniques"][0]["reason"], "one participant has no spread");
  EXPECT_TRUE(part["paired_t"][0]["p_value"].is_null());
  EXPECT_EQ(part["paired_t"][0]["reason"], "only one participant saw both");
  EXPECT_TRUE(part["friedman"]["f_p_value"].is_null());
  EXPECT_EQ(part["subsets"], json::parse(R"([["a", "b"]])"));
}

TEST_F(Degenerate, OneTechnique) {
  const json part = overall({row_of("P1", "car", "a", 1), row_of("P2", "car", "a", 1)});
  EXPECT_TRUE(part["paired_t"].empty());
  EXPECT_TRUE(part["friedman"]["chi_square"].is_null());
  EXPECT_EQ(part["friedman"]["reason"], "no block holds two values");
  EXPECT_EQ(part["letters"], json::parse(R"({"a": "a"})"));
}

TEST_F(Degenerate, AllTied) {
  std::vector<ResponseRow> rows;
  for (const char* person : {"P1", "P2", "P3"}) {
    for (const char* technique : {"a", "b", "c"})
      rows.push_back(row_of(person, "car", technique, 2));
  }
  const json part = overall(rows);
  EXPECT_EQ(part["friedman"]["reason"], "every block is tied throughout");
  EXPECT_EQ(part["quade"]["reason"], "every block is tied throughout");
  EXPECT_EQ(part["paired_t"][0]["p_value"], 1.0);
  EXPECT_EQ(part["paired_t"][0]["reason"], "all differences are zero");
  EXPECT_TRUE(part["wilcoxon"][0]["statistic_v"].is_null());
  EXPECT_EQ(part["sign"][0]["p_value"], 1.0);
  EXPECT_EQ(part["subsets"].size(), 1u);
}

TEST_F(Degenerate, ZeroVariance) {
  std::vector<ResponseRow> rows;
  for (const char* person : {"P1", "P2", "P3"}) {
    rows.push_back(row_of(person, "car", "a", 1));
    rows.push_back(row_of(person, "car", "b", 2));
  }
  const json part = overall(rows);
  EXPECT_TRUE(part["paired_t"][0]["t"].is_null());
  EXPECT_EQ(part["paired_t"][0]["p_value"], 0.0);
  EXPECT_EQ(part["paired_t"][0]["reason"], "all differences are equal: t is unbounded");
  EXPECT_TRUE(part["friedman"]["iman_davenport_f"].is_null());
  EXPECT_EQ(part["friedman"]["f_p_value"], 0.0);
  EXPECT_EQ(part["friedman"]["kendalls_w"], 1.0);
}

TEST_F(Degenerate, ZeroWeights) {
  std::vector<ResponseRow> rows;
  for (const char* person : {"P1", "P2"}) {
    for (const char* technique : {"a", "b"}) {
      rows.push_back(row_of(person, "car", technique, technique[0] == 'a' ? 1 : 2));
      rows.back().weight = 0.0;
    }
  }
  const json part = overall(rows);
  EXPECT_TRUE(part["techniques"][0]["weighted_mean_rank"].is_null());
  EXPECT_EQ(part["techniques"][0]["reason"], "all weights are zero");
  EXPECT_EQ(part["techniques"][0]["mean_rank"], 1.0);
}

TEST_F(Degenerate, NoDifficultyAnywhereMeansEqualWeights) {
  const json report = statistics_report(
      {row_of("P1", "car", "a", 1, std::nullopt), row_of("P1", "car", "b", 2, std::nullopt)}, {});
  EXPECT_EQ(report["included_sets"]["all"]["overall"]["techniques"][0]["weighted_mean_rank"], 1.0);
  EXPECT_THAT(report["notes"].dump(), HasSubstr("every page weighs 1"));
}

TEST_F(Degenerate, PicturesThatSomeDidNotSeeAreNeverRankedLast) {
  // P3 saw only b and c: a keeps its n of 2 and its mean rank of 1.
  const json part = overall({row_of("P1", "car", "a", 1), row_of("P1", "car", "b", 2),
                             row_of("P1", "car", "c", 3), row_of("P2", "car", "a", 1),
                             row_of("P2", "car", "b", 3), row_of("P2", "car", "c", 2),
                             row_of("P3", "car", "b", 1), row_of("P3", "car", "c", 2)});
  EXPECT_EQ(entry(part["techniques"], "technique", "a")["n"], 2);
  EXPECT_EQ(entry(part["techniques"], "technique", "a")["mean_rank"], 1.0);
  EXPECT_EQ(entry(part["techniques"], "technique", "b")["n"], 3);
  EXPECT_FALSE(part["skillings_mack"]["statistic"].is_null());
  EXPECT_TRUE(part["friedman"]["kendalls_w"].is_null());
  EXPECT_EQ(part["friedman"]["reason"], "some blocks are incomplete");
}

}  // namespace report_tests
}  // namespace penumbra::study
